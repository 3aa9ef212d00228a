// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// Hardware without hardware (`--sim`): every coil of the map has a line here (but latched ones, which have
/// none), and so has every discrete input with a line or a wire, wired as the map's `sim:` says; any other is
/// its firmware's. An input with no wire keeps the level that it was given. Nothing bounces, so nothing is
/// debounced. No edge is missed: those of square waves are computed, with their times. Other changes have the
/// time at which they are told. Processes forked from this one use the same chip.
class SimulatedChip : public Lines {
 public:
  /// Outputs and unwired inputs are at their initial levels; square waves begin now, with their `on` half.
  SimulatedChip(const Map& map, TimePoint now);

  /// The limit of changes of one input. Of more changes the newest are told (or one less, so that the first
  /// one brings another level than the last one told), and the others are lost. Counters and latched points
  /// count all of them.
  static constexpr std::uint32_t most_changes = 64;

  void take_edges(TimePoint now, EdgeSink& sink) override;
  std::optional<TimePoint> next_change(TimePoint now) const override;
  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) override;
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override;
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override;
  bool drive_safe() override;
  bool is_simulated() const override { return true; }
  bool pull(modbus::Range inputs, Span<const std::uint16_t> levels) override;

  /// Goes on where that of another map was: levels of outputs and unwired inputs of the same name, and time.
  void take_over(const SimulatedChip& before);

  /// Functions for tests, which act from outside. Names are those of points of the map.
  void pull(std::string_view input, bool level);  ///< an unwired input
  bool level(std::string_view output) const;
  /// Unplugged, nothing can be read or driven, and no edge is seen.
  void plug(bool in) {
    state_[0].plugged = in;
    state_[0].was_away |= !in;
  }

 private:
  struct Output {
    const Point* point;
    bool level;
  };
  struct Input {
    const Point* point;
    bool level;
    const SimWire* wire;  ///< null: none
    const Output* from;   ///< null: no wire, or a square wave
    Edges edges;          ///< not told yet
    bool told;            ///< the level that was told last
  };

  struct State {
    TimePoint told{};  ///< edges until then
    bool plugged = true;
    bool was_away = false;  ///< since then
  };

  static std::vector<Output> outputs_of(const Map& map);
  static std::vector<Input> inputs_of(const Map& map, Span<const Output> outputs);
  std::uint16_t level_of(const Input& input, TimePoint now) const;
  /// How many edges a square wave has had at `now`; even ones rise.
  std::uint64_t square_edges(const SimWire& wire, TimePoint now) const;
  TimePoint time_of_edge(const SimWire& wire, std::uint64_t edge) const;
  void tell(Input& input, TimePoint now, EdgeSink& sink) const;
  void tell_return(Input& input, TimePoint now, EdgeSink& sink) const;
  void set(Output& output, bool level);
  static void set(Input& input, bool level);

  SharedArray<Output> outputs_;  ///< ascending addresses
  SharedArray<Input> inputs_;    ///< ascending addresses
  SharedArray<State> state_{1};
  TimePoint start_;
};

}  // namespace coupler::device
