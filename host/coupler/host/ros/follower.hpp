// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// Sees what the one connection to a device that is driven reads anyway, besides ROS: a recording, a panel.
class Follower {
 public:
  virtual ~Follower() = default;

  /// Gets what the device's thread reads.
  virtual Sink& sink() = 0;
  /// How the device is, some ten times a second while anything changes. `revision`: another one if the
  /// qualities may be others than the last time.
  virtual void judge(const DeviceSnapshot& device, const std::vector<PointQuality>& qualities,
                     std::uint64_t revision, Time now) = 0;
  /// From now on a lost connection is no news.
  virtual void end_comes() {}
  /// After the outputs are safe: takes its time if a disk does.
  virtual void end() {}
};

}  // namespace coupler::host
