// SPDX-License-Identifier: Apache-2.0
// What the topic `points` says.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "coupler/codec/scale.hpp"
#include "coupler/map/map.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

/// Fills `min` and `max` of a coupler_driver/PointInfo: NaN if it is no number, or if only the device knows
/// the scale.
template <class Message>
void put_range(Message& message, const Point& point) {
  message.min = message.max = std::numeric_limits<double>::quiet_NaN();
  if (holds_bits(point.table) || !codec::is_scalable(point.format.type) || point.scale.has_exponent()) return;
  const auto [least, most] = codec::published_range(point.format, point.scale);
  message.min = std::max(least, point.bounds.min);
  message.max = std::min(most, point.bounds.max);
  // The largest integer of 64 bits is no double, and the nearest one is beyond it.
  const bool is_beyond = !point.scale.present() && !codec::is_float(point.format.type) &&
                         codec::width(point.format.type) == 64 && message.max == most;
  if (is_beyond) message.max = std::nextafter(most, 0.0);
}

/// Fills a coupler_driver/PointInfo. `type`: of the messages with its values.
template <class Message>
void fill(Message& message, const Map& map, const Point& point, const std::string& type) {
  message.name = std::string(point.name);
  message.description = std::string(point.description);
  message.table = std::string(to_string(point.table));
  message.address = point.address;
  message.type = std::string(to_string(point.format.type));
  message.count = point.count;
  message.message = type;
  message.access = std::string(to_string(point.access));
  message.stamped = point.host.stamped;
  message.rate = plan::why_not_read(map, point) ? 0 : plan::rate_of(map, point);
  message.units = std::string(point.units);
  put_range(message, point);
  for (const NamedValue& named : point.values) {
    message.values.push_back(named.value);
    message.value_names.emplace_back(named.name);
  }
}

/// Fills a coupler_driver/Points. `type_of(point)`: the type of the messages with its values.
template <class Message, class TypeOf>
Message points_of(const Map& map, TypeOf type_of) {
  Message message;
  message.points.resize(map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i)
    fill(message.points[i], map, map.points[i], type_of(map.points[i]));
  return message;
}

}  // namespace coupler::host
