// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/health.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// A device on /diagnostics (REP 107): connection, polling, writes, and the
/// coupler's own watchdog where the driver makes use of it. The hardware id is its name and address.
class Diagnostics {
 public:
  /// Adds its entries to the node's. What `map` views outlives it.
  Diagnostics(const Map& map, Node& node);

  /// What to say next. True: it should not wait, since the device came or went.
  bool update(const DeviceSnapshot& device, const std::vector<PointQuality>& points);

 private:
  Diagnosis connection();
  Diagnosis polling();
  Diagnosis writes();
  Diagnosis watchdog();

  Map map_;
  std::string hardware_id_;
  DeviceSnapshot next_;
  DeviceSnapshot before_;  ///< what the message before told
  DeviceSnapshot now_;     ///< what this one tells
  std::vector<PointQuality> points_;
};

}  // namespace coupler::host
