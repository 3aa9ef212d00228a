// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::plan {

/// Why a request ends where it does.
struct Cut {
  enum class Reason : std::uint8_t {
    end_of_table,  ///< no further point is to be read
    other_rate,    ///< what follows is read at another rate
    unreadable,    ///< addresses that must not be read lie in between, or the device refused to read across
    write_only,    ///< a point that can only be written lies in between
    unmapped,      ///< unmapped addresses lie in between, and the map does not say that they may be read
    gap,           ///< as many addresses lie in between as the gap of the map, or more
    limit          ///< the request would be longer than the device takes
  };
  Reason reason = Reason::end_of_table;
  std::optional<std::uint32_t> next{};  ///< index of the first point that is not in the request
  std::uint32_t between = 0;            ///< addresses between the request and `next`
};

/// The range and the points of one read request.
struct ReadSpan {
  Table table;
  modbus::Range range;
  std::vector<std::uint32_t> points;  ///< indices into Map::points, by address; each lies inside `range`
  Cut end{};
};

/// Returns the addresses that a request for `own` has to ask for: those, and the whole of each area of
/// Map::read_whole that has one of them.
modbus::Range read_extent(const Map& map, Table table, modbus::Range own);
inline modbus::Range read_extent(const Map& map, const Point& point) {
  return read_extent(map, point.table, read_range(point));
}

/// Returns the range from the first address of either to the last one of either.
modbus::Range hull(modbus::Range a, modbus::Range b);

/// Calls `at_hole` with the count of points before each hole, and the hole.
template <class AtHole>
void for_each_hole(const ReadSpan& span, const Map& map, AtHole&& at_hole) {
  std::uint32_t end = span.range.start();
  for (std::size_t i = 0; i < span.points.size(); ++i) {
    const modbus::Range range = read_extent(map, map.points[span.points[i]]);
    if (range.start() > end) at_hole(i, modbus::Range::of(end, range.start() - end));
    end = std::max(end, range.end());
  }
}

/// The addresses inside a request that no point of it needs.
std::vector<modbus::Range> holes(const ReadSpan& span, const Map& map);

}  // namespace coupler::plan
