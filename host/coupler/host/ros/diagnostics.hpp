// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/health.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The diagnostics are published this often, and at once when a device comes or goes.
constexpr auto diagnostics_interval = std::chrono::seconds(1);

/// On /diagnostics, for a map that a device serves: the entry `map`, the only one until the map has come.
class MapDiagnostics {
 public:
  /// Without a node nothing is published.
  MapDiagnostics(const Connection& device, Node* node);

  /// Sets what the next message says.
  void say(Level level, const std::string& text);
  /// To be called now and then while nothing else publishes the diagnostics.
  void publish_if_due();

 private:
  Node* node_;
  std::shared_ptr<DiagnosticEntry> entry_ = std::make_shared<DiagnosticEntry>();  ///< the node has it, too
  Time due_ = Time::min();
};

/// A device on /diagnostics (REP 107): connection, polling, writes, and the coupler's own watchdog if the
/// driver uses it. The hardware id is the device's name and address.
class Diagnostics {
 public:
  /// Adds its entries to the node's. What `map` views outlives it.
  Diagnostics(const Map& map, Node& node);

  /// Sets what the next message says. Returns true if it should not wait, since the device came online or
  /// went offline.
  /// `slow`: see Pace::trouble().
  bool update(const DeviceSnapshot& device, const std::vector<PointQuality>& points, const std::string& slow);

 private:
  DiagnosticEntry connection();
  DiagnosticEntry polling();
  DiagnosticEntry writes();
  DiagnosticEntry watchdog();
  DiagnosticEntry certificates();

  Map map_;
  std::string hardware_id_;
  DeviceSnapshot next_;
  DeviceSnapshot before_;  ///< of the message before
  DeviceSnapshot now_;     ///< of this message
  std::vector<PointQuality> points_;
  std::string slow_;
};

}  // namespace coupler::host
