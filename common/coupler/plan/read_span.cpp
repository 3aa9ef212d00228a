// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/read_span.hpp"

#include <algorithm>

namespace coupler::plan {

using modbus::Range;

Range hull(Range a, Range b) {
  const std::uint32_t start = std::min(a.start(), b.start());
  return Range::of(start, std::max(a.end(), b.end()) - start);
}

Range read_extent(const Map& map, Table table, Range own) {
  const auto* area =
      std::partition_point(map.read_whole.begin(), map.read_whole.end(), [&](const TableRange& each) {
        return index(each.table) < index(table) || (each.table == table && each.range.end() <= own.start());
      });
  Range extent = own;
  for (; area != map.read_whole.end() && area->table == table && area->range.start() < own.end(); ++area)
    extent = hull(extent, area->range);
  return extent;
}

std::vector<Range> holes(const ReadSpan& span, const Map& map) {
  std::vector<Range> result;
  for_each_hole(span, map, [&](std::size_t /*before*/, Range hole) { result.push_back(hole); });
  return result;
}

}  // namespace coupler::plan
