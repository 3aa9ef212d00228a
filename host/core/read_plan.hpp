// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/map/map.hpp"

namespace coupler::driver {

/// What one read request covers.
struct ReadSpan {
  Table table;
  modbus::Range range;
  std::vector<std::uint32_t> points;  ///< indices into Map::points, by address; each lies inside `range`
};

/// The requests that read every readable point of the map, few of them: points are joined while they touch or
/// overlap, or, where unmapped addresses may be read, while fewer than the table's gap lie between them, and
/// as long as the device's limit allows. A point is never split. Ordered by table and address.
std::vector<ReadSpan> make_read_plan(const Map& map);

/// The smaller requests to try when the device rejects `span`: the same points without the unmapped addresses
/// between them, or, where there are none, the two halves of the points. Empty if the span holds one point
/// only.
std::vector<ReadSpan> split(const ReadSpan& span, const Map& map);

}  // namespace coupler::driver
