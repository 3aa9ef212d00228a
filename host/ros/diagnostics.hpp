// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <vector>

#include "common/map/map.hpp"
#include "host/core/device_statistics.hpp"
#include "host/core/health.hpp"
#include "host/core/point_quality.hpp"

namespace coupler::driver {

/// A device on /diagnostics (REP 107): connection, polling, writes, and the
/// coupler's own watchdog where the driver makes use of it. The hardware id is its name and address.
class Diagnostics {
 public:
  /// What `map` views must outlive it.
  explicit Diagnostics(const Map& map);

  /// Publishes.
  void update(const DeviceSnapshot& device, const std::vector<PointQuality>& points);

 private:
  using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;
  void connection(Wrapper& status);
  void polling(Wrapper& status);
  void writes(Wrapper& status);
  void watchdog(Wrapper& status);

  Map map_;
  DeviceSnapshot before_;
  DeviceSnapshot now_;
  std::vector<PointQuality> points_;
  diagnostic_updater::Updater updater_;
};

}  // namespace coupler::driver
