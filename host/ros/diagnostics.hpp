// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
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
  /// `updater` publishes what all devices of the process say as one message: a publisher of /diagnostics
  /// keeps only the newest. It outlives the diagnostics, and is not used once they are gone. What `map` views
  /// outlives it too.
  Diagnostics(const Map& map, diagnostic_updater::Updater& updater);

  /// What to say next. True: it should not wait, since the device came or went.
  bool update(const DeviceSnapshot& device, const std::vector<PointQuality>& points);

 private:
  using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;
  void connection(Wrapper& status);
  void polling(Wrapper& status);
  void writes(Wrapper& status);
  void watchdog(Wrapper& status);

  Map map_;
  std::string hardware_id_;
  DeviceSnapshot next_;
  DeviceSnapshot before_;  ///< what the message before told
  DeviceSnapshot now_;     ///< what this one tells
  std::vector<PointQuality> points_;
};

}  // namespace coupler::driver
