// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/rights.hpp"

#include <algorithm>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {

Rights::Rights(const Map& map, const ClientSession& client)
    : map_(map), role_(client.role), are_limited_(map.security.present()) {
  if (client.is_plain) role_ = map.security.plain_role();
}

bool Rights::may(Right right, const Point& point) const {
  if (!are_limited_) return true;
  return role_ != nullptr && role_->may(right, static_cast<std::size_t>(&point - map_.points.begin()));
}

bool Rights::may(Right right, Table table, modbus::Range range) const {
  if (!are_limited_) return true;
  const auto points = touched_points(map_, table, range);
  return std::all_of(points.begin(), points.end(), [&](const Point& point) { return may(right, point); });
}

/// A mask that changes no point's bits is a write all the same: it drives outputs again, and feeds the
/// watchdog.
bool Rights::may_write_bits(std::uint16_t address, std::uint16_t bits) const {
  if (!are_limited_) return true;
  const auto points = touched_points(map_, Table::holding_registers, modbus::Range::of(address, 1));
  const auto is_changed = [bits](const Point& point) { return (own_bits(point) & bits) != 0; };
  const bool changes_nothing = std::none_of(points.begin(), points.end(), is_changed);
  return std::all_of(points.begin(), points.end(), [&](const Point& point) {
    return !(changes_nothing || is_changed(point)) || may(Right::write, point);
  });
}

bool Rights::may_write_any() const {
  if (!are_limited_) return true;
  return role_ != nullptr && std::any_of(map_.points.begin(), map_.points.end(),
                                         [&](const Point& point) { return may(Right::write, point); });
}

}  // namespace coupler::device
