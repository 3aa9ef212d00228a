// SPDX-License-Identifier: Apache-2.0
#include "device/core/edge_points.hpp"

#include <algorithm>
#include <tuple>

#include "common/codec/number.hpp"

namespace coupler::node {
namespace {

using modbus::Range;

constexpr std::uint16_t widest_counter = 4;  ///< registers

/// Calls `use` with each point that begins in the range; the map's points are sorted.
template <class Use>
void each_point(const Map& map, Table table, std::uint32_t start, std::uint32_t end, Use use) {
  const auto key = [](const Point& p) { return std::tuple(index(p.table), std::uint32_t{p.address}); };
  auto point = std::lower_bound(map.points.begin(), map.points.end(), std::tuple(index(table), start),
                                [&](const Point& p, const auto& wanted) { return key(p) < wanted; });
  for (; point != map.points.end() && key(*point) < std::tuple(index(table), end); ++point) use(*point);
}

std::uint32_t of_kind(Edge edge, const Edges& edges) {
  switch (edge) {
    case Edge::rising: return edges.rising;
    case Edge::falling: return edges.falling;
    case Edge::both: break;
  }
  return edges.rising + edges.falling;
}

template <class T>
void raise(std::uint16_t* registers, codec::Order order, std::uint32_t by) {
  codec::encode(static_cast<T>(codec::decode<T>(registers, order) + by), order, registers);
}

std::uint16_t mask_of(const Point& point) {
  return holds_bits(point.table) ? std::uint16_t{1} : codec::mask(point.format);
}

}  // namespace

void EdgePoints::add(std::uint16_t address, const Edges& edges) {
  statistics_.events_lost += edges.lost;
  each_point(map_, Table::discrete_inputs, address, address + 1U, [&](const Point& input) {
    for (const Point& point : map_.points) {
      if (point.counter.input == input.name) count(point, of_kind(point.counter.edge, edges));
      if (point.latched.input == input.name && of_kind(point.latched.edge, edges) != 0) latch(point);
    }
  });
}

void EdgePoints::count(const Point& point, std::uint32_t edges) {
  std::uint16_t* registers = image_.find(point.table, range(point)).data();
  const codec::Order order = point.format.order;
  switch (codec::registers(point.format)) {
    case 1: return raise<std::uint16_t>(registers, order, edges);
    case 2: return raise<std::uint32_t>(registers, order, edges);
    default: return raise<std::uint64_t>(registers, order, edges);
  }
}

void EdgePoints::latch(const Point& point) {
  std::uint16_t& cell = image_.find(point.table, range(point))[0];
  cell = static_cast<std::uint16_t>(cell | mask_of(point));
}

bool EdgePoints::holds_whole_counters(Range written) const {
  bool whole = true;
  const std::uint32_t first = std::max<std::uint32_t>(written.start(), widest_counter) - widest_counter;
  each_point(map_, Table::holding_registers, first, written.end(), [&](const Point& point) {
    if (point.counter.present() && written.overlaps(range(point))) whole &= written.contains(range(point));
  });
  return whole;
}

void EdgePoints::keep_latches(Table table, Range written, Span<const std::uint16_t> now,
                              Span<std::uint16_t> next) const {
  each_point(map_, table, written.start(), written.end(), [&](const Point& point) {
    if (!point.latched.present()) return;
    const std::size_t i = point.address - written.start();
    const std::uint16_t mask = mask_of(point);
    next[i] = static_cast<std::uint16_t>(next[i] & (now[i] | ~mask));
  });
}

}  // namespace coupler::node
