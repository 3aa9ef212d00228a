// SPDX-License-Identifier: Apache-2.0
#include "common/plan/split.hpp"

#include <algorithm>

namespace coupler::plan {
namespace {

using modbus::Range;

ReadSpan piece(const ReadSpan& span, std::size_t from, std::size_t to, const Map& map) {
  ReadSpan result{span.table, read_range(map.points[span.points[from]]), {}};
  const std::uint32_t start = result.range.start();
  for (std::size_t i = from; i < to; ++i) {
    const std::uint32_t end = std::max(result.range.end(), read_range(map.points[span.points[i]]).end());
    result.range = Range::of(start, end - start);
    result.points.push_back(span.points[i]);
  }
  return result;
}

/// Calls `at_hole` with the count of points before each hole, and the hole.
template <class AtHole>
void for_each_hole(const ReadSpan& span, const Map& map, AtHole&& at_hole) {
  std::uint32_t end = span.range.start();
  for (std::size_t i = 0; i < span.points.size(); ++i) {
    const Range range = read_range(map.points[span.points[i]]);
    if (range.start() > end) at_hole(i, Range::of(end, range.start() - end));
    end = std::max(end, range.end());
  }
}

}  // namespace

std::vector<Range> holes(const ReadSpan& span, const Map& map) {
  std::vector<Range> result;
  for_each_hole(span, map, [&](std::size_t /*before*/, Range hole) { result.push_back(hole); });
  return result;
}

Split split(const ReadSpan& span, const Map& map) {
  const std::size_t count = span.points.size();
  if (count < 2) return {};
  const std::size_t middle = count / 2;
  const auto distance = [middle](std::size_t i) { return i > middle ? i - middle : middle - i; };
  Split result;
  std::size_t at = middle;
  for_each_hole(span, map, [&](std::size_t before, Range hole) {
    if (result.hole && distance(before) >= distance(at)) return;
    at = before;
    result.hole = hole;
  });
  result.pieces = {piece(span, 0, at, map), piece(span, at, count, map)};
  return result;
}

}  // namespace coupler::plan
