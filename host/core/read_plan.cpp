// SPDX-License-Identifier: Apache-2.0
#include "host/core/read_plan.hpp"

#include <algorithm>

namespace coupler::driver {
namespace {

/// When a further point may join a request.
struct Rule {
  std::uint32_t limit;  ///< addresses in one request
  std::uint32_t gap;    ///< unmapped addresses in between, fewer than this; 1: none
};

Rule rule_of(const Map& map, Table table) {
  if (holds_bits(table))
    return {map.limits.read_bits, map.polling.discrete_continuous ? map.polling.discrete_gap : 1U};
  return {map.limits.read_registers, map.polling.register_continuous ? map.polling.register_gap : 1U};
}

/// `span` with `next`, which starts no earlier, or nullopt if they must be read apart.
std::optional<modbus::Range> joined(modbus::Range span, modbus::Range next, Rule rule) {
  // A gap of 0 in the map joins nothing that is apart; touching points have no distance to compare.
  if (next.start() > span.end() && next.start() - span.end() >= rule.gap) return std::nullopt;
  const std::uint32_t end = std::max(span.end(), next.end());
  if (end - span.start() > rule.limit) return std::nullopt;
  return modbus::Range::of(span.start(), end - span.start());
}

void add(std::vector<ReadSpan>& spans, const Map& map, std::uint32_t index, Rule rule) {
  const Point& point = map.points[index];
  if (!spans.empty() && spans.back().table == point.table) {
    ReadSpan& last = spans.back();
    if (const auto range_of_both = joined(last.range, range(point), rule)) {
      last.range = *range_of_both;
      last.points.push_back(index);
      return;
    }
  }
  spans.push_back({point.table, range(point), {index}});
}

}  // namespace

std::vector<ReadSpan> make_read_plan(const Map& map) {
  std::vector<ReadSpan> spans;
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (is_readable(map.points[i])) add(spans, map, i, rule_of(map, map.points[i].table));
  return spans;
}

std::vector<ReadSpan> split(const ReadSpan& span, const Map& map) {
  std::vector<ReadSpan> pieces;
  if (span.points.size() == 1) return pieces;
  const Rule no_holes{span.range.count(), 1};
  for (const std::uint32_t index : span.points) add(pieces, map, index, no_holes);
  if (pieces.size() > 1) return pieces;

  pieces.clear();
  const std::size_t half = span.points.size() / 2;
  for (std::size_t i = 0; i < span.points.size(); ++i) {
    const std::uint32_t index = span.points[i];
    if (i == 0 || i == half) {
      pieces.push_back({span.table, range(map.points[index]), {index}});
    } else {
      const modbus::Range next = range(map.points[index]);
      ReadSpan& piece = pieces.back();
      const std::uint32_t end = std::max(piece.range.end(), next.end());
      piece.range = modbus::Range::of(piece.range.start(), end - piece.range.start());
      piece.points.push_back(index);
    }
  }
  return pieces;
}

}  // namespace coupler::driver
