// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>

#include "host/core/write.hpp"

namespace coupler::driver {

/// What the subscriptions of a device share.
struct WriteHandler {
  std::function<void(const Write&)> accept;
  /// The value cannot be written: the point's index, if there is such a point, what was wrong and the remedy.
  std::function<void(std::optional<std::uint32_t> point, const std::string& what)> refuse;
};

/// Subscribes to `topic` with the message type of `map.points[index]`. The handler is called in ROS's network
/// thread and must wait for nothing. Map and handler must outlive the subscription.
ros::Subscriber subscribe(ros::NodeHandle& handle, const std::string& topic, const Map& map,
                          std::uint32_t index, const WriteHandler& handler);

}  // namespace coupler::driver
