// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// Hardware without hardware (`--sim`): every coil of the map has a line here (but latched ones, which have
/// none), and so has every discrete input with a line or a wire, wired as the map's `sim:` says; any other is
/// its firmware's. An input with no wire keeps the level that it was given. Nothing bounces, so nothing is
/// debounced. No edge is missed: those of square waves are computed. Processes forked from this one use the
/// same chip.
class SimulatedChip : public Lines {
 public:
  /// Outputs and unwired inputs are at their initial levels; square waves begin now, with their `on` half.
  SimulatedChip(const Map& map, TimePoint now);

  void take_edges(TimePoint now, EdgeSink& sink) override;
  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) override;
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override;
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override;
  bool drive_safe() override;

  /// Goes on where that of another map was: levels of outputs and unwired inputs of the same name, and time.
  void take_over(const SimulatedChip& before);

  /// What a test does from outside. Names are those of points of the map.
  void pull(std::string_view input, bool level);  ///< an unwired input
  bool level(std::string_view output) const;
  void plug(bool in) { state_[0].plugged = in; }  ///< unplugged, nothing can be read or driven

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
  };

  struct State {
    TimePoint told{};  ///< edges until then
    bool plugged = true;
  };

  static std::vector<Output> outputs_of(const Map& map);
  static std::vector<Input> inputs_of(const Map& map, Span<const Output> outputs);
  std::uint16_t level_of(const Input& input, TimePoint now) const;
  Edges edges_of_square(const SimWire& wire, TimePoint now) const;
  void set(Output& output, bool level);

  SharedArray<Output> outputs_;  ///< ascending addresses
  SharedArray<Input> inputs_;    ///< ascending addresses
  SharedArray<State> state_{1};
  TimePoint start_;
};

}  // namespace coupler::device
