// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <coupler_driver/Status.h>
#include <ros/node_handle.h>

#include <vector>

#include "common/map/map.hpp"
#include "host/core/device_statistics.hpp"
#include "host/core/point_quality.hpp"

namespace coupler::driver {

/// The latched topic `<name>/status`.
class StatusPublisher {
 public:
  /// What `map` views must outlive it.
  StatusPublisher(ros::NodeHandle& handle, const Map& map);

  /// Publishes when a quality, the identity or `online` is not what it was, and after a second.
  void update(const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time now);

 private:
  bool fill(const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time now);

  Map map_;
  coupler_driver::Status message_;
  Time published_ = Time::min();
  ros::Publisher publisher_;
};

}  // namespace coupler::driver
