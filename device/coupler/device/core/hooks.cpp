// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/hooks.hpp"

#include <algorithm>

namespace coupler::device {

using modbus::Range;

/// Points of a table follow each other without overlap; only parts of one register begin and end alike.
HookedPoints::Indices HookedPoints::touched(Table table, Range range) const {
  const Point* const begin = map_.points.begin();
  const auto* first = std::partition_point(begin, map_.points.end(), [&](const Point& point) {
    return point.table < table || (point.table == table && coupler::range(point).end() <= range.start());
  });
  const auto* end = std::partition_point(first, map_.points.end(), [&](const Point& point) {
    return point.table == table && point.address < range.end();
  });
  return {static_cast<std::uint32_t>(first - begin), static_cast<std::uint32_t>(end - begin)};
}

Span<const std::uint16_t> HookedPoints::before(std::uint32_t point) const {
  const Point& which = map_.points[point];
  return image_.find(which.table, range(which));
}

/// If so, value_ holds what the point is to be.
bool HookedPoints::is_asked(std::uint32_t point, Range range, Span<const std::uint16_t> next) {
  const Point& which = map_.points[point];
  if (!is_hooked_output(which)) return false;
  const auto now = before(point);
  std::copy(now.begin(), now.end(), value_.begin());
  const Range own = coupler::range(which);
  for (std::uint32_t at = std::max(own.start(), range.start()); at < std::min(own.end(), range.end()); ++at)
    value_[at - own.start()] = next[at - range.start()];
  return !is_partial(which) || ((value_[0] ^ now[0]) & codec::mask(which.format)) != 0;
}

bool HookedPoints::write(Table table, Range range, Span<const std::uint16_t> next) {
  const auto [first, end] = touched(table, range);
  for (std::uint32_t point = first; point < end; ++point) {
    if (!is_asked(point, range, next) || hooks_.accept(point, value_.data())) continue;
    take_back({first, point}, range, next);
    return false;
  }
  return true;
}

void HookedPoints::take_back(Table table, Range range, Span<const std::uint16_t> next) {
  take_back(touched(table, range), range, next);
}

/// The last one first, as one undoes.
void HookedPoints::take_back(Indices points, Range range, Span<const std::uint16_t> next) {
  for (std::uint32_t point = points.end; point-- > points.first;)
    if (is_asked(point, range, next)) (void)hooks_.accept(point, before(point).begin());
}

bool HookedPoints::has_output(Table table, Range range) const {
  const auto [first, end] = touched(table, range);
  return std::any_of(map_.points.begin() + first, map_.points.begin() + end, is_hooked_output);
}

}  // namespace coupler::device
