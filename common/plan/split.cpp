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

/// The places, as counts of points before them, where a hole is.
std::vector<std::size_t> holes(const ReadSpan& span, const Map& map) {
  std::vector<std::size_t> result;
  std::uint32_t end = span.range.start();
  for (std::size_t i = 0; i < span.points.size(); ++i) {
    const Range range = read_range(map.points[span.points[i]]);
    if (range.start() > end) result.push_back(i);
    end = std::max(end, range.end());
  }
  return result;
}

}  // namespace

Split split(const ReadSpan& span, const Map& map) {
  const std::size_t count = span.points.size();
  if (count < 2) return {};
  std::size_t at = count / 2;
  const auto distance = [middle = at](std::size_t i) { return i > middle ? i - middle : middle - i; };
  const std::vector<std::size_t> candidates = holes(span, map);
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  if (best != candidates.end()) at = *best;
  Split result{{piece(span, 0, at, map), piece(span, at, count, map)}};
  const std::uint32_t end = result.pieces.front().range.end();
  const std::uint32_t start = result.pieces.back().range.start();
  if (start > end) result.hole = Range::of(end, start - end);
  return result;
}

}  // namespace coupler::plan
