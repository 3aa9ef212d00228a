// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "coupler/map/map.hpp"

namespace coupler::device {

/// The registers of the widest number, which is all that a point with hardware, or a counter, can be.
constexpr std::uint16_t widest_number = 4;

/// Calls `use` with each point that begins in start … end - 1; the map's points are sorted.
template <class Use>
void each_point(const Map& map, Table table, std::uint32_t start, std::uint32_t end, Use use) {
  const auto key = [](const Point& p) { return std::tuple(index(p.table), std::uint32_t{p.address}); };
  const auto* point = std::lower_bound(map.points.begin(), map.points.end(), std::tuple(index(table), start),
                                       [&](const Point& p, const auto& wanted) { return key(p) < wanted; });
  for (; point != map.points.end() && key(*point) < std::tuple(index(table), end); ++point) use(*point);
}

/// Calls `use` with each point of one number that has a register in the range. Longer ones are met only if
/// they begin near it.
template <class Use>
void each_number(const Map& map, Table table, modbus::Range touched, Use use) {
  const std::uint32_t first = std::max<std::uint32_t>(touched.start(), widest_number) - widest_number;
  each_point(map, table, first, touched.end(), [&](const Point& point) {
    if (touched.overlaps(range(point))) use(point);
  });
}

/// The points of any length that have an address in the range. Points of a table follow each other without
/// overlap; only parts of one register begin and end alike.
inline Span<const Point> touched_points(const Map& map, Table table, modbus::Range touched) {
  const Point* first = std::partition_point(map.points.begin(), map.points.end(), [&](const Point& point) {
    return point.table < table || (point.table == table && range(point).end() <= touched.start());
  });
  const Point* end = std::partition_point(first, map.points.end(), [&](const Point& point) {
    return point.table == table && point.address < touched.end();
  });
  return {first, static_cast<std::size_t>(end - first)};
}

}  // namespace coupler::device
