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

bool starts_on(const Point& point) { return !point.initial.empty() && point.initial[0] != 0; }

bool is_safe_on(const Point& point) {
  return point.safe == Safe::on && (point.safe_value.empty() || point.safe_value[0] != 0);
}

}  // namespace

SimulatedChip::SimulatedChip(const Map& map, TimePoint now)
    : outputs_(outputs_of(map)), inputs_(inputs_of(map, outputs_.all())), start_(now) {
  state_[0].told = now;
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
    all.push_back({&point, starts_on(point), wire, from, {}});
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

Edges SimulatedChip::edges_of_square(const SimWire& wire, TimePoint now) const {
  // It is on from the start: the first falling edge is after half a period, the first rising one after one.
  const std::chrono::nanoseconds period = wire.square;
  const std::chrono::nanoseconds off = wire.square - wire.square / 2;
  const auto since_told = [&](std::chrono::nanoseconds lead) {
    return static_cast<std::uint32_t>((std::max(now, state_[0].told) - start_ + lead) / period -
                                      (state_[0].told - start_ + lead) / period);
  };
  Edges edges{since_told(std::chrono::nanoseconds(0)), since_told(off), 0};
  if (wire.invert) std::swap(edges.rising, edges.falling);
  return edges;
}

void SimulatedChip::take_edges(TimePoint now, EdgeSink& sink) {
  if (!state_[0].plugged) return;
  for (Input& input : inputs_.all()) {
    Edges edges = std::exchange(input.edges, {});
    if (input.wire != nullptr && input.wire->square.count() > 0) edges = edges_of_square(*input.wire, now);
    if (edges.any()) sink.add(input.point->address, edges);
  }
  state_[0].told = std::max(state_[0].told, now);
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
    }
}

void SimulatedChip::pull(std::string_view input, bool level) {
  Input* line = named(inputs_.all(), input);
  assert(line != nullptr && line->wire == nullptr);
  if (line->level != level) ++(level ? line->edges.rising : line->edges.falling);
  line->level = level;
}

bool SimulatedChip::level(std::string_view output) const {
  const Output* line = named(outputs_.all(), output);
  assert(line != nullptr);
  return line->level;
}

}  // namespace coupler::device
