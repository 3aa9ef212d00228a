// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// Sees what the one connection to a device that is driven reads anyway, besides ROS: a recording, a panel.
class Follower {
 public:
  virtual ~Follower() = default;

  /// Gets what the device's thread reads.
  virtual Sink& sink() = 0;
  /// Receives the counts of the device, some ten times a second while anything changes.
  virtual void report(const DeviceSnapshot& /*device*/, Time /*now*/) {}
  /// Nobody reads the point any more, or somebody does again. It must not wait for anything.
  virtual void wanted(std::uint32_t /*point*/) {}
  /// The device's services are there, and its thread runs.
  virtual void begin() {}
  /// Somebody writes the point, or has done so. It must not wait for anything.
  virtual void write_comes(std::uint32_t /*point*/) {}
  /// Safe values were requested. It must not wait for anything.
  virtual void safe_comes() {}
  /// From now on a lost connection is no news.
  virtual void end_comes() {}
  /// After the outputs are safe: takes its time if a disk does.
  virtual void end() {}
};

}  // namespace coupler::host
