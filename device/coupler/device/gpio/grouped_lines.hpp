// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/gpio/event_source.hpp"
#include "coupler/device/gpio/fault.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/device/gpio/lost_edges.hpp"
#include "coupler/device/supervisor/shared_array.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// The level of an output in its safe state, if its level is `now`.
inline int safe_level(Safe safe, int now) { return safe == Safe::hold ? now : safe == Safe::on ? 1 : 0; }

/// An output group and the coils that it drives. The vectors have one element for each line of the group.
struct WiredOutputs {
  std::shared_ptr<OutputGroup> group;
  std::vector<std::optional<std::uint16_t>> addresses;  ///< nullopt: a line that no coil has any more
  std::vector<Safe> safe;
  std::vector<int> levels;  ///< at which they are driven
  bool readback = false;    ///< its levels are compared after each call that drives it
};

/// An input group and the discrete inputs that it reads.
struct WiredInputs {
  std::shared_ptr<InputGroup> group;
  std::vector<std::optional<std::uint16_t>> addresses;
  EventSource* events = nullptr;  ///< the group, if it reports edges
  bool counted = false;           ///< counters or latched points want them
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

  void add(WiredOutputs wired);
  void add(WiredInputs wired);
  /// Lets go of all groups.
  void release();

  std::size_t output_groups() const { return outputs_.size(); }
  std::size_t input_groups() const { return inputs_.size(); }
  const WiredOutputs& outputs(std::size_t group) const { return outputs_[group].wired; }
  const WiredInputs& inputs(std::size_t group) const { return inputs_[group].wired; }
  /// As its lines are driven.
  Span<const int> levels(std::size_t output_group) const { return outputs_[output_group].levels(); }
  /// The descriptors to be watched.
  std::vector<EventSource*> events() const;

  /// A group's chip was unplugged: what needs it fails from now on, and nothing of it is held any more.
  void lose_outputs(std::size_t group);
  void lose_inputs(std::size_t group);
  /// It is back, requested anew.
  void renew_outputs(std::size_t group, WiredOutputs again);
  void renew_inputs(std::size_t group, WiredInputs again);

  /// Takes the place of `before`: lines that only that one drives go to their safe state, and groups of both
  /// are driven here as they are there.
  void take_over(GroupedLines& before);

 private:
  /// What processes share: a level for each line, and the group's last error.
  using Shared = std::unique_ptr<SharedArray<int>>;
  struct Output {
    WiredOutputs wired;
    Shared shared;
    std::vector<int> next;  ///< what a write asks for
    Fault fault;
    bool driven = false;  ///< by the write in progress

    Span<int> levels() const { return shared->all().first(next.size()); }
  };
  struct Input {
    WiredInputs wired;
    Shared shared;
    Fault fault;
    LostEdges lost;
  };

  Output output(WiredOutputs wired);
  Input input(WiredInputs wired);
  static int drive(Output& output, Span<int> scratch);
  void restore();
  static void abandon(Output& old, const Output* successor);

  Log& log_;
  std::vector<Output> outputs_;
  std::vector<Input> inputs_;
  std::array<int, max_group_size> scratch_{};
};

}  // namespace coupler::device
