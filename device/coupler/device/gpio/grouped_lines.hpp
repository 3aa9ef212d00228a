// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/gpio/fault.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/point.hpp"

namespace coupler::device {

/// A line of this machine and how it was requested.
struct HeldLine {
  std::string chip;  ///< the kernel's name
  unsigned offset = 0;
  bool output = false;
  bool active_low = false;
  Bias bias = Bias::as_is;
  Drive drive = Drive::push_pull;
  std::chrono::microseconds debounce{0};
  std::optional<Edge> counted{};
  bool watched = false;          ///< its edges are wanted
  const Point* point = nullptr;  ///< that is wired to it; null: none of the map
};

/// The lines that a group's request to the kernel holds.
struct HeldRequest {
  std::vector<HeldLine> lines{};  ///< in the order of the group
  bool lost = false;              ///< the chip is unplugged
  bool sampled = false;           ///< inputs that are looked at, since they report no edges
  std::string error{};            ///< why the lines cannot be requested again, as it was logged
};

/// An output group and the coils that it drives.
struct WiredOutputs {
  struct Line {
    std::optional<std::uint16_t> address;  ///< nullopt: no coil has it any more
    Safe safe = Safe::off;
    int level = 0;  ///< at which it is driven
  };
  std::shared_ptr<OutputGroup> group;
  std::vector<Line> lines;
  bool readback = false;  ///< its levels are compared after each call that drives it
  HeldRequest request{};
};

/// An input group and the discrete inputs that it reads.
struct WiredInputs {
  std::shared_ptr<InputGroup> group;
  std::vector<std::optional<std::uint16_t>> addresses;
  HeldRequest request{};
};

/// Drives and reads any number of groups as one: a write that needs several of them is done by all or by
/// none. Processes forked from this one use the same lines, and all of them know how outputs are driven, if
/// only one at a time drives them.
class GroupedLines : public Lines {
 public:
  GroupedLines(std::vector<WiredOutputs> outputs, std::vector<WiredInputs> inputs, Log& log);

  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) override;
  void take_edges(TimePoint now, EdgeSink& sink) override;
  std::optional<TimePoint> next_change(TimePoint now) const override;
  bool has_to_look() const override;
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override;
  bool drive_each(modbus::Range coils, Span<const std::uint16_t> levels) override;
  bool are_plugged(modbus::Range coils) const override;
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override;
  bool drive_safe() override;
  /// The same for the outputs of one group.
  [[nodiscard]] bool drive_safe(std::size_t group);
  /// The group's chip, or its bus, hangs: in this process, what needs it fails from now on.
  void give_up_outputs(std::size_t group);

  void add(WiredOutputs wired);
  void add(WiredInputs wired);
  /// Releases all groups.
  void release();

  std::size_t output_groups() const { return outputs_.size(); }
  const std::string& name_of_outputs(std::size_t group) const { return outputs_[group].wired.group->name(); }
  std::size_t input_groups() const { return inputs_.size(); }
  WiredOutputs& outputs(std::size_t group) { return outputs_[group].wired; }
  WiredInputs& inputs(std::size_t group) { return inputs_[group].wired; }
  /// The groups whose descriptors are to be watched.
  std::vector<InputGroup*> event_sources() const;

  /// A group's chip was unplugged: what needs it fails from now on, and nothing of it is held any more.
  void lose_outputs(std::size_t group);
  void lose_inputs(std::size_t group);
  /// It is plugged in again, and its lines have been requested again.
  void renew_outputs(std::size_t group, WiredOutputs again);
  void renew_inputs(std::size_t group, WiredInputs again);
  /// No other process drives any more: outputs that were renewed since the last call have the levels that it
  /// has left.
  void settle();

  /// Replaces `before`: lines that only `before` drives go to their safe state, and groups of both stay
  /// driven as they are.
  void take_over(GroupedLines& before);

 private:
  /// The data that processes share: a level for each line, and the group's last error.
  using Shared = std::unique_ptr<SharedArray<int>>;
  struct Output {
    WiredOutputs wired;
    Shared shared;
    std::vector<int> next;  ///< what a write asks for
    Fault fault;
    bool driven = false;      ///< by the write in progress
    bool is_renewed = false;  ///< settle() is to follow

    Span<int> levels() const { return shared->all().first(next.size()); }
  };
  /// An input's level when its chip was unplugged.
  enum class Before : std::uint8_t { unknown, off, on };
  struct Input {
    WiredInputs wired;
    Shared shared;
    std::unique_ptr<SharedArray<Before>> before;  ///< one for each line; unknown once the difference was told
    Fault fault;
    LostEdges lost;
  };

  static Shared levels_of(const WiredOutputs& wired);
  Output output(WiredOutputs wired, Shared shared);
  Input input(WiredInputs wired);
  class Teller;
  static int drive(Output& output, Span<int> scratch);
  static int verify(Output& output, Span<int> scratch);
  enum class Driven : std::uint8_t { yes, no, unplugged };
  Driven drive_alone(Output& output);
  void restore();
  static void abandon(Output& old, const Output* successor);

  Log& log_;
  std::vector<Output> outputs_;
  std::vector<Input> inputs_;
  std::array<int, max_group_size> scratch_{};
};

}  // namespace coupler::device
