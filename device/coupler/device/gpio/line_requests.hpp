// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "coupler/device/gpio/inventory.hpp"
#include "coupler/device/gpio/wiring.hpp"

namespace coupler::device {

/// The line as it is when it has been requested.
HeldLine held_as(const LineSpec& wanted);

bool is_same_line(const HeldLine& a, const HeldLine& b);
/// Returns whether both are one line, requested in the same way.
bool is_same_request(const HeldLine& a, const HeldLine& b);

/// A group of these lines, wired to their points.
WiredOutputs wired_outputs(std::shared_ptr<OutputGroup> group, const std::vector<LineSpec>& lines,
                           bool readback);
WiredInputs wired_inputs(std::shared_ptr<InputGroup> group, const std::vector<LineSpec>& lines);
/// The same of inputs that report no edges.
WiredInputs sampled_inputs(std::unique_ptr<InputGroup> plain, const std::vector<LineSpec>& lines);

/// GPIO lines of this machine, each held by one of several requests.
class LineRequests : public Wiring {
 public:
  /// The GPIO lines of the map, found and requested by the libgpiod that is built in (backend.hpp): as few
  /// requests as it allows, each of up to max_group_size lines. Lines that `before` (may be null) holds with
  /// the same settings stay in their requests, which cannot release single lines: a line of such a request
  /// that the map does not want any more stays held, an output in its safe state.
  static Prepared prepare(const Map& map, LineRequests* before, bool safe, Log& log);

  explicit LineRequests(Log& log) : lines_({}, {}, log), log_(log) {}

  Lines& lines() override { return lines_; }
  std::vector<InputGroup*> event_sources() const override { return lines_.event_sources(); }
  std::size_t output_groups() const override { return lines_.output_groups(); }
  std::string name_of_outputs(std::size_t group) const override { return lines_.name_of_outputs(group); }
  bool drive_safe(std::size_t group) override { return lines_.drive_safe(group); }
  void give_up_outputs(std::size_t group) override { lines_.give_up_outputs(group); }
  bool reconnect(bool safe) override;
  void settle() override { lines_.settle(); }
  Prepared prepare_next(const Map& map, bool safe, Log& log) override;

  GroupedLines& groups() { return lines_; }

  /// Requests lines that fit together and adds them. Inputs that report no edges are sampled, which is
  /// logged. The error names chip, line and holder.
  tl::expected<void, std::string> request(const std::vector<LineSpec>& lines, bool readback);
  /// Adds lines that cannot be requested now; reconnect() will request them.
  void add_missing(const std::vector<LineSpec>& lines, bool readback);

 private:
  bool lose();
  bool renew(bool safe);
  bool renew_outputs(std::size_t group, const std::vector<LineSpec>& lines, bool safe);
  bool renew_inputs(std::size_t group, const std::vector<LineSpec>& lines);
  tl::expected<void, std::string> request_apart(const std::vector<LineSpec>& lines, const std::string& error);
  tl::expected<void, std::string> request_sampled(const std::vector<LineSpec>& lines, std::string_view why);
  void fail(HeldRequest& held, const std::string& error);

  GroupedLines lines_;
  Log& log_;
};

}  // namespace coupler::device
