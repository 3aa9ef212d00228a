// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/simulated_chip.hpp"

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupler/map/lookup_by_name.hpp"

namespace coupler::device {
namespace {

using modbus::Range;

/// The lines whose address is in the range.
template <class Line>
Span<Line> in_range(Span<Line> lines, Range range) {
  const auto below = [](const auto& line, std::uint32_t address) { return line.point->address < address; };
  const auto first = std::lower_bound(lines.begin(), lines.end(), std::uint32_t{range.start()}, below);
  const auto last = std::lower_bound(first, lines.end(), range.end(), below);
  return lines.sub(static_cast<std::size_t>(first - lines.begin()), static_cast<std::size_t>(last - first));
}

template <class Line>
auto by_name(Span<Line> lines) {
  return LookupByName(lines, [](const Line& line) { return line.point->name; });
}

template <class Line>
Line* named(Span<Line> lines, std::string_view name) {
  return by_name(lines).find(name);
}

bool is_square(const SimWire* wire) { return wire != nullptr && wire->square.count() > 0; }

bool starts_on(const Point& point) { return !point.initial.empty() && point.initial[0] != 0; }

bool is_safe_on(const Point& point) {
  return point.safe == Safe::on && (point.safe_value.empty() || point.safe_value[0] != 0);
}

}  // namespace

SimulatedChip::SimulatedChip(const Map& map, TimePoint now)
    : outputs_(outputs_of(map)), inputs_(inputs_of(map, outputs_.all())), start_(now) {
  state_[0].told = now;
  for (Input& input : inputs_.all()) input.told = level_of(input, now) != 0;
}

std::vector<SimulatedChip::Output> SimulatedChip::outputs_of(const Map& map) {
  std::vector<Output> all;
  for (const Point& point : map.points)
    if (point.table == Table::coils && !point.latched.present()) all.push_back({&point, starts_on(point)});
  return all;
}

std::vector<SimulatedChip::Input> SimulatedChip::inputs_of(const Map& map, Span<const Output> outputs) {
  LookupByName wires(map.sim, [](const SimWire& wire) { return wire.to; });
  auto by_output = by_name(outputs);
  std::vector<Input> all;
  for (const Point& point : map.points) {
    if (point.table != Table::discrete_inputs) continue;
    const SimWire* wire = wires.find(point.name);
    if (wire == nullptr && !point.line.present()) continue;
    const Output* from = wire == nullptr ? nullptr : by_output.find(wire->from);
    all.push_back({&point, starts_on(point), wire, from, {}, false});
  }
  return all;
}

std::uint16_t SimulatedChip::level_of(const Input& input, TimePoint now) const {
  if (input.wire == nullptr) return input.level ? 1 : 0;
  bool level = false;
  if (input.from != nullptr)
    level = input.from->level;
  else if (const auto period = input.wire->square; period.count() > 0)
    level = (now - start_) % period < period / 2;
  return level != input.wire->invert ? 1 : 0;
}

std::uint64_t SimulatedChip::square_edges(const SimWire& wire, TimePoint now) const {
  const std::chrono::nanoseconds period = wire.square;
  const auto since = std::max(now, start_) - start_;
  return static_cast<std::uint64_t>(since / period) * 2 + (since % period >= period / 2 ? 1 : 0);
}

TimePoint SimulatedChip::time_of_edge(const SimWire& wire, std::uint64_t edge) const {
  const std::chrono::nanoseconds period = wire.square;
  return start_ + static_cast<std::int64_t>(edge / 2) * period + (edge % 2) * (period / 2);
}

/// The edges of one input until `now`, and as many of its changes as are kept.
void SimulatedChip::tell(Input& input, TimePoint now, EdgeSink& sink) const {
  const bool level = level_of(input, now) != 0;
  Edges edges = std::exchange(input.edges, {});
  std::uint64_t last = 0;
  if (is_square(input.wire)) {
    last = square_edges(*input.wire, now);
    const std::uint64_t told = square_edges(*input.wire, state_[0].told);
    edges = {static_cast<std::uint32_t>(last / 2 - told / 2),
             static_cast<std::uint32_t>((last + 1) / 2 - (told + 1) / 2), 0};
    if (input.wire->invert) std::swap(edges.rising, edges.falling);
  }
  if (!edges.any()) return;
  sink.add(input.point->address, edges);
  input.told = level;
  const std::uint32_t changes = edges.rising + edges.falling;
  std::uint32_t kept = std::min(changes, most_changes);
  // Behind an odd number of lost ones would be the level that was told last, which is no change.
  kept -= (changes - kept) % 2;
  if (changes > kept) sink.lost(changes - kept);
  for (std::uint32_t ago = kept; ago-- > 0;)
    sink.changed(input.point->address, level == (ago % 2 == 0),
                 is_square(input.wire) ? time_of_edge(*input.wire, last - ago) : now);
}

/// The chip is back: edges meanwhile were not seen.
void SimulatedChip::tell_return(Input& input, TimePoint now, EdgeSink& sink) const {
  input.edges = {};
  const bool level = level_of(input, now) != 0;
  if (std::exchange(input.told, level) != level) sink.changed(input.point->address, level, now);
}

void SimulatedChip::take_edges(TimePoint now, EdgeSink& sink) {
  if (!state_[0].plugged) return;
  now = std::max(now, state_[0].told);
  const bool was_away = std::exchange(state_[0].was_away, false);
  for (Input& input : inputs_.all())
    if (was_away)
      tell_return(input, now, sink);
    else
      tell(input, now, sink);
  state_[0].told = now;
}

std::optional<TimePoint> SimulatedChip::next_change(TimePoint now) const {
  if (!state_[0].plugged) return std::nullopt;
  if (state_[0].was_away) return now;
  std::optional<TimePoint> next;
  for (const Input& input : inputs_.all()) {
    if (input.edges.any()) return now;
    if (!is_square(input.wire)) continue;
    const TimePoint its = time_of_edge(*input.wire, square_edges(*input.wire, state_[0].told) + 1);
    if (!next || its < *next) next = its;
  }
  return next;
}

bool SimulatedChip::read(Range inputs, Span<std::uint16_t> levels, TimePoint now) {
  if (!state_[0].plugged) return false;
  for (const Input& input : in_range(inputs_.all(), inputs))
    levels[input.point->address - inputs.start()] = level_of(input, now);
  return true;
}

bool SimulatedChip::drive(Range coils, Span<const std::uint16_t> levels) {
  if (!state_[0].plugged) return false;
  for (Output& output : in_range(outputs_.all(), coils))
    set(output, levels[output.point->address - coils.start()] != 0);
  return true;
}

bool SimulatedChip::driven(Range coils, Span<std::uint16_t> levels) const {
  const auto outputs = in_range(outputs_.all(), coils);
  for (const Output& output : outputs) levels[output.point->address - coils.start()] = output.level ? 1 : 0;
  return !outputs.empty();
}

bool SimulatedChip::drive_safe() {
  if (!state_[0].plugged) return false;
  for (Output& output : outputs_.all())
    if (output.point->safe != Safe::hold) set(output, is_safe_on(*output.point));
  return true;
}

void SimulatedChip::set(Output& output, bool level) {
  if (output.level == level) return;
  output.level = level;
  for (Input& input : inputs_.all())
    if (input.from == &output) ++(level != input.wire->invert ? input.edges.rising : input.edges.falling);
}

void SimulatedChip::set(Input& input, bool level) {
  if (std::exchange(input.level, level) != level) ++(level ? input.edges.rising : input.edges.falling);
}

bool SimulatedChip::pull(Range inputs, Span<const std::uint16_t> levels) {
  if (!state_[0].plugged) return false;
  const auto lines = in_range(inputs_.all(), inputs);
  if (std::any_of(lines.begin(), lines.end(), [](const Input& input) { return input.wire != nullptr; }))
    return false;
  for (Input& input : lines) set(input, levels[input.point->address - inputs.start()] != 0);
  return true;
}

void SimulatedChip::take_over(const SimulatedChip& before) {
  start_ = before.start_;
  state_[0].told = before.state_[0].told;
  auto outputs = by_name(before.outputs_.all());
  for (Output& output : outputs_.all())
    if (const Output* old = outputs.find(output.point->name)) output.level = old->level;
  auto inputs = by_name(before.inputs_.all());
  for (Input& input : inputs_.all())
    if (const Input* old = inputs.find(input.point->name)) {
      input.level = old->level;
      input.edges = old->edges;
      input.told = old->told;
    }
}

void SimulatedChip::pull(std::string_view input, bool level) {
  Input* line = named(inputs_.all(), input);
  assert(line != nullptr && line->wire == nullptr);
  set(*line, level);
}

bool SimulatedChip::level(std::string_view output) const {
  const Output* line = named(outputs_.all(), output);
  assert(line != nullptr);
  return line->level;
}

}  // namespace coupler::device
