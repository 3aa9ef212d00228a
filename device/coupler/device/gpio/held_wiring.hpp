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
struct Held {
  std::vector<HeldLine> lines;
  std::vector<const Point*> points;  ///< for each line; null: no point of the map is wired to it
  bool lost = false;                 ///< its chip is gone
  std::string refusal{};             ///< why its lines cannot be requested again, as the log has it
};

/// GPIO lines of this machine, each held by one of several requests.
class HeldWiring : public Wiring {
 public:
  explicit HeldWiring(Log& log) : lines_({}, {}, log), log_(log) {}

  Lines& lines() override { return lines_; }
  std::vector<EventSource*> events() const override { return lines_.events(); }
  bool mend(bool safe) override;

  GroupedLines& groups() { return lines_; }
  /// In the order of the groups.
  const std::vector<Held>& outputs() const { return outputs_; }
  const std::vector<Held>& inputs() const { return inputs_; }

  /// Lets go of all lines that no other wiring goes on with.
  void release();

  /// A group goes on from another wiring of this process, its lines wired to these points.
  void keep_outputs(WiredOutputs wired, Held held);
  void keep_inputs(WiredInputs wired, Held held);
  /// Requests lines that fit together and adds them. The error names chip, line and holder.
  tl::expected<void, std::string> request(const std::vector<Wanted>& lines, bool readback);
  /// Adds lines that cannot be had now; mend() will request them.
  void miss(const std::vector<Wanted>& lines, bool readback);

 private:
  bool lose();
  bool renew(bool safe);
  bool renew_outputs(std::size_t group, const std::vector<Wanted>& lines, bool safe);
  bool renew_inputs(std::size_t group, const std::vector<Wanted>& lines);
  void refuse(Held& held, const std::string& refusal);

  GroupedLines lines_;
  std::vector<Held> outputs_;
  std::vector<Held> inputs_;
  Log& log_;
};

}  // namespace coupler::device
