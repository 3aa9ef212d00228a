// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/hooks.hpp"

#include <algorithm>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {

using modbus::Range;

HookedPoints::Indices HookedPoints::touched(Table table, Range range) const {
  const auto points = touched_points(map_, table, range);
  const auto first = static_cast<std::uint32_t>(points.begin() - map_.points.begin());
  return {first, first + static_cast<std::uint32_t>(points.size())};
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
  each_shared_address(own, range,
                      [&](std::uint32_t at) { value_[at - own.start()] = next[at - range.start()]; });
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

bool HookedPoints::write_each(Table table, Range range, Span<std::uint16_t> next) {
  bool good = true;
  const auto [first, end] = touched(table, range);
  for (std::uint32_t point = first; point < end; ++point) {
    if (!is_asked(point, range, next)) continue;
    const auto now = before(point);
    if (std::equal(now.begin(), now.end(), value_.begin()) || hooks_.accept(point, value_.data())) continue;
    const Point& which = map_.points[point];
    const std::uint16_t mask = own_bits(which);
    const Range own = coupler::range(which);
    each_shared_address(own, range, [&](std::uint32_t at) {
      std::uint16_t& cell = next[at - range.start()];
      cell = static_cast<std::uint16_t>((cell & ~mask) | (now[at - own.start()] & mask));
    });
    good = false;
  }
  return good;
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
