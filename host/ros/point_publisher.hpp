// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "common/map/map.hpp"
#include "host/core/clock.hpp"
#include "host/ros/listeners.hpp"

namespace coupler::driver {

/// The topic of one readable point. It keeps its message, so that a value costs no allocation of ours.
class PointPublisher {
 public:
  virtual ~PointPublisher() = default;
  /// The point's registers as they came `at`; bit tables: each bit as one register, 0 or 1. Publishes them
  /// where the point's policy calls them news.
  virtual void publish(const std::uint16_t* registers, Time at) = 0;
  /// The next value is news whatever it is.
  virtual void renew() = 0;
};

/// Advertises `topic` with the message type of `map.points[index]`, and tells `listeners` who comes and who
/// leaves. What `map` views, and the listeners, must outlive it.
std::unique_ptr<PointPublisher> advertise(ros::NodeHandle& handle, const std::string& topic, const Map& map,
                                          std::uint32_t index, Listeners& listeners);

}  // namespace coupler::driver
