// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/split_span.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace coupler::plan {

using modbus::Range;

namespace {

ReadSpan piece(const ReadSpan& span, std::size_t from, std::size_t to, const Map& map) {
  ReadSpan result{span.table, read_extent(map, map.points[span.points[from]]), {}};
  for (std::size_t i = from; i < to; ++i) {
    result.range = hull(result.range, read_extent(map, map.points[span.points[i]]));
    result.points.push_back(span.points[i]);
  }
  return result;
}

constexpr std::size_t distance(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }

/// How many points go to the first half: as near to half of them as is possible without parting those that
/// overlap, for each part would need the same addresses. Half of them if all overlap.
std::size_t middle_boundary(const ReadSpan& span, const Map& map) {
  const std::size_t middle = span.points.size() / 2;
  std::optional<std::size_t> best;
  std::uint32_t end = read_extent(map, map.points[span.points.front()]).end();
  for (std::size_t i = 1; i < span.points.size(); ++i) {
    const Range range = read_extent(map, map.points[span.points[i]]);
    const bool apart = range.start() >= end;
    if (apart && (!best || distance(i, middle) < distance(*best, middle))) best = i;
    end = std::max(end, range.end());
  }
  return best.value_or(middle);
}

}  // namespace

Split split(const ReadSpan& span, const Map& map) {
  const std::size_t count = span.points.size();
  if (count < 2) return {};
  const std::size_t middle = count / 2;
  Split result;
  std::size_t at = middle_boundary(span, map);
  for_each_hole(span, map, [&](std::size_t before, Range hole) {
    if (result.hole && distance(before, middle) >= distance(at, middle)) return;
    at = before;
    result.hole = hole;
  });
  result.pieces = {piece(span, 0, at, map), piece(span, at, count, map)};
  return result;
}

}  // namespace coupler::plan
