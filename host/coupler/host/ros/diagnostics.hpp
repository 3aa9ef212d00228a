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

/// A device on /diagnostics (REP 107): connection, polling, writes, and the coupler's own watchdog if the
/// driver uses it. The hardware id is the device's name and address.
class Diagnostics {
 public:
  /// Adds its entries to the node's. What `map` views outlives it.
  Diagnostics(const Map& map, Node& node);

  /// What the next message says. True: it should not wait, since the device came online or went offline.
  bool update(const DeviceSnapshot& device, const std::vector<PointQuality>& points);

 private:
  DiagnosticEntry connection();
  DiagnosticEntry polling();
  DiagnosticEntry writes();
  DiagnosticEntry watchdog();

  Map map_;
  std::string hardware_id_;
  DeviceSnapshot next_;
  DeviceSnapshot before_;  ///< of the message before
  DeviceSnapshot now_;     ///< of this message
  std::vector<PointQuality> points_;
};

}  // namespace coupler::host
