// SPDX-License-Identifier: Apache-2.0
// A device's state as text and level: the rules behind /diagnostics.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

struct Health {
  Level level;  ///< info: all is well
  std::string text;
};

/// error: offline; warning: online with a map that differs.
Health connection_health(const DeviceSnapshot& now);

/// error: online, and none of the points that are read is good; warning: some are not, or a cycle has been
/// left out since `before`.
Health polling_health(const Map& map, const std::vector<PointQuality>& points, const DeviceSnapshot& before,
                      const DeviceSnapshot& now);

/// warning: a write since `before` failed.
Health writes_health(const DeviceSnapshot& before, const DeviceSnapshot& now);

/// The coupler's own watchdog. error: it has expired, or it is not fed.
Health watchdog_health(const DeviceSnapshot& now);

/// Returns the health of a TLS connection. error: one of its certificates has expired, so the next connect
/// fails; warning: one soon does.
Health certificates_health(const std::optional<Certificates>& certificates,
                           std::chrono::system_clock::time_point at);

/// "foreign", "equal", …; "not asked".
std::string_view to_string(const std::optional<Identity::Verdict>& verdict);

}  // namespace coupler::host
