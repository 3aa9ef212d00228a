// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/map/point.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::host {

/// How many messages with the positions of joints wait for a subscriber: as many as publishers
/// of ROS usually keep.
constexpr std::uint32_t joints_depth = 10;

/// How many messages of a point wait for a subscriber: as many as the map says. Where it says nothing, and a
/// node may tell the point's changes, those of two replies: all of one reply are published at once.
inline std::uint32_t topic_depth(const Point& point) {
  constexpr std::uint32_t usual = HostOptions{}.queue_size;
  constexpr std::uint32_t two_replies = 2 * modbus::max_changes;
  static_assert(two_replies > usual);
  return holds_bits(point.table) && point.host.queue_size == usual ? two_replies : point.host.queue_size;
}

}  // namespace coupler::host
