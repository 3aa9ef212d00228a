// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/rights.hpp"

#include <algorithm>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {

Rights::Rights(const Map& map) : map_(map), is_limited_(map.security.present()) {
  if (map.security.plain) role_ = &map.security.roles[*map.security.plain];
}

bool Rights::may(Right right, const Point& point) const {
  return role_ != nullptr && role_->may(right, static_cast<std::size_t>(&point - map_.points.begin()));
}

bool Rights::may(Right right, Table table, modbus::Range range) const {
  if (!is_limited_) return true;
  const auto points = touched_points(map_, table, range);
  return std::all_of(points.begin(), points.end(), [&](const Point& point) { return may(right, point); });
}

bool Rights::may_write_bits(std::uint16_t address, std::uint16_t bits) const {
  if (!is_limited_) return true;
  const auto points = touched_points(map_, Table::holding_registers, modbus::Range::of(address, 1));
  return std::all_of(points.begin(), points.end(), [&](const Point& point) {
    return (own_bits(point) & bits) == 0 || may(Right::write, point);
  });
}

/// Those that have a line or a channel, as Hardware::driven() says.
bool Rights::may_reset_watchdog() const {
  if (!is_limited_) return true;
  return std::all_of(map_.points.begin(), map_.points.end(),
                     [&](const Point& point) { return !is_writable(point) || may(Right::write, point); });
}

}  // namespace coupler::device
