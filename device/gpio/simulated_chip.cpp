// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/simulated_chip.hpp"

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <utility>

namespace coupler::node {
namespace {

using modbus::Range;

/// The lines whose address is in the range.
template <class Lines>
auto in_range(Lines& lines, Range range) {
  const auto below = [](const auto& line, std::uint32_t address) { return line.point->address < address; };
  const auto first = std::lower_bound(lines.begin(), lines.end(), std::uint32_t{range.start()}, below);
  const auto last = std::lower_bound(first, lines.end(), range.end(), below);
  return Span<std::remove_reference_t<decltype(*first)>>(lines).sub(
      static_cast<std::size_t>(first - lines.begin()), static_cast<std::size_t>(last - first));
}

template <class Lines>
auto* named(Lines& lines, std::string_view name) {
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.point->name == name; });
  return found == lines.end() ? nullptr : &*found;
}

bool starts_on(const Point& point) { return !point.initial.empty() && point.initial[0] != 0; }

bool is_safe_on(const Point& point) {
  return point.safe == Safe::on && (point.safe_value.empty() || point.safe_value[0] != 0);
}

}  // namespace

SimulatedChip::SimulatedChip(const Map& map, TimePoint now) : start_(now), told_(now) {
  for (const Point& point : map.points) {
    if (point.table == Table::coils && !point.latched.present())
      outputs_.push_back({&point, starts_on(point)});
    if (point.table == Table::discrete_inputs)
      inputs_.push_back({&point, starts_on(point), nullptr, nullptr, {}});
  }
  for (const SimWire& wire : map.sim) {
    Input* to = named(inputs_, wire.to);
    if (to == nullptr) continue;
    to->wire = &wire;
    to->from = named(outputs_, wire.from);
  }
  const auto has_no_line = [](const Input& input) {
    return input.wire == nullptr && !input.point->line.present();
  };
  inputs_.erase(std::remove_if(inputs_.begin(), inputs_.end(), has_no_line), inputs_.end());
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
    return static_cast<std::uint32_t>((std::max(now, told_) - start_ + lead) / period -
                                      (told_ - start_ + lead) / period);
  };
  Edges edges{since_told(std::chrono::nanoseconds(0)), since_told(off), 0};
  if (wire.invert) std::swap(edges.rising, edges.falling);
  return edges;
}

void SimulatedChip::take_edges(TimePoint now, EdgeSink& sink) {
  if (!plugged_) return;
  for (Input& input : inputs_) {
    Edges edges = std::exchange(input.edges, {});
    if (input.wire != nullptr && input.wire->square.count() > 0) edges = edges_of_square(*input.wire, now);
    if (edges.any()) sink.add(input.point->address, edges);
  }
  told_ = std::max(told_, now);
}

bool SimulatedChip::read(Range inputs, Span<std::uint16_t> levels, TimePoint now) {
  if (!plugged_) return false;
  for (const Input& input : in_range(inputs_, inputs))
    levels[input.point->address - inputs.start()] = level_of(input, now);
  return true;
}

bool SimulatedChip::drive(Range coils, Span<const std::uint16_t> levels) {
  if (!plugged_) return false;
  for (Output& output : in_range(outputs_, coils))
    set(output, levels[output.point->address - coils.start()] != 0);
  return true;
}

bool SimulatedChip::driven(Range coils, Span<std::uint16_t> levels) const {
  const auto outputs = in_range(outputs_, coils);
  for (const Output& output : outputs) levels[output.point->address - coils.start()] = output.level ? 1 : 0;
  return !outputs.empty();
}

bool SimulatedChip::drive_safe() {
  if (!plugged_) return false;
  for (Output& output : outputs_)
    if (output.point->safe != Safe::hold) set(output, is_safe_on(*output.point));
  return true;
}

void SimulatedChip::set(Output& output, bool level) {
  if (output.level == level) return;
  output.level = level;
  for (Input& input : inputs_)
    if (input.from == &output) ++(level != input.wire->invert ? input.edges.rising : input.edges.falling);
}

void SimulatedChip::succeed(const SimulatedChip& before) {
  start_ = before.start_;
  told_ = before.told_;
  for (Output& output : outputs_)
    if (const Output* old = named(before.outputs_, output.point->name)) output.level = old->level;
  for (Input& input : inputs_)
    if (const Input* old = named(before.inputs_, input.point->name)) {
      input.level = old->level;
      input.edges = old->edges;
    }
}

void SimulatedChip::pull(std::string_view input, bool level) {
  Input* line = named(inputs_, input);
  assert(line != nullptr && line->wire == nullptr);
  if (line->level != level) ++(level ? line->edges.rising : line->edges.falling);
  line->level = level;
}

bool SimulatedChip::level(std::string_view output) const {
  const Output* line = named(outputs_, output);
  assert(line != nullptr);
  return line->level;
}

}  // namespace coupler::node
