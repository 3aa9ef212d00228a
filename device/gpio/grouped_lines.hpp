// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/map/line.hpp"
#include "device/core/lines.hpp"
#include "device/gpio/event_source.hpp"
#include "device/gpio/fault.hpp"
#include "device/gpio/line_group.hpp"
#include "device/gpio/lost_edges.hpp"
#include "device/keeper/shared_array.hpp"

namespace coupler::node {

/// An output group and the coils that it drives. The vectors have one element for each line of the group.
struct WiredOutputs {
  std::unique_ptr<OutputGroup> group;
  std::vector<std::uint16_t> addresses;  ///< ascending
  std::vector<Safe> safe;
  std::vector<int> levels;  ///< at which the group was requested
  bool readback = false;    ///< its levels are compared after each call that drives it
};

/// An input group and the discrete inputs that it reads.
struct WiredInputs {
  std::unique_ptr<InputGroup> group;
  std::vector<std::uint16_t> addresses;  ///< ascending
  EventSource* counted = nullptr;        ///< the group, if edges of its lines are counted
};

/// Drives and reads any number of groups as one: a write that needs several of them is done by all or by
/// none. Processes forked from this one use the same lines, and all of them know how outputs are driven as
/// long as one at a time drives them.
class GroupedLines : public Lines {
 public:
  GroupedLines(std::vector<WiredOutputs> outputs, std::vector<WiredInputs> inputs, Log& log);

  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) override;
  void take_edges(TimePoint now, EdgeSink& sink) override;
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override;
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override;
  bool drive_safe() override;

 private:
  struct Output {
    WiredOutputs wired;
    Span<int> levels;       ///< as driven, one for each line
    std::vector<int> next;  ///< what a write asks for
    Fault fault;
    bool driven = false;  ///< by the write in progress
  };
  struct Input {
    WiredInputs wired;
    Fault fault;
    LostEdges lost;
  };

  static int drive(Output& output, Span<int> scratch);
  void restore();

  SharedArray<int> levels_;
  std::vector<Output> outputs_;
  std::vector<Input> inputs_;
  std::array<int, max_group_size> scratch_{};
};

}  // namespace coupler::node
