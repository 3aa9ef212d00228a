// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "coupler/device/gpio/held_line.hpp"
#include "coupler/device/gpio/wiring.hpp"

namespace coupler::device {

/// What one request to the kernel holds.
struct HeldRequest {
  std::vector<HeldLine> lines;
  std::vector<const Point*> points;  ///< for each line; null: no point of the map is wired to it
  bool lost = false;                 ///< its chip is gone
  std::string refusal{};             ///< why its lines cannot be requested again, as the log has it
};

/// GPIO lines of this machine, each held by one of several requests.
class LineRequests : public Wiring {
 public:
  explicit LineRequests(Log& log) : lines_({}, {}, log), log_(log) {}

  Lines& lines() override { return lines_; }
  std::vector<EventSource*> events() const override { return lines_.events(); }
  bool mend(bool safe) override;

  GroupedLines& groups() { return lines_; }
  /// In the order of the groups.
  const std::vector<HeldRequest>& outputs() const { return outputs_; }
  const std::vector<HeldRequest>& inputs() const { return inputs_; }

  /// Lets go of all lines that no other wiring goes on with.
  void release();

  /// A group goes on from another wiring of this process, its lines wired to these points.
  void keep_outputs(WiredOutputs wired, HeldRequest held);
  void keep_inputs(WiredInputs wired, HeldRequest held);
  /// Requests lines that fit together and adds them. The error names chip, line and holder.
  tl::expected<void, std::string> request(const std::vector<LineSpec>& lines, bool readback);
  /// Adds lines that cannot be had now; mend() will request them.
  void add_missing(const std::vector<LineSpec>& lines, bool readback);

 private:
  bool lose();
  bool renew(bool safe);
  bool renew_outputs(std::size_t group, const std::vector<LineSpec>& lines, bool safe);
  bool renew_inputs(std::size_t group, const std::vector<LineSpec>& lines);
  void refuse(HeldRequest& held, const std::string& refusal);

  GroupedLines lines_;
  std::vector<HeldRequest> outputs_;
  std::vector<HeldRequest> inputs_;
  Log& log_;
};

}  // namespace coupler::device
