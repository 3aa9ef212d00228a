// SPDX-License-Identifier: Apache-2.0
// A port of the commands: the values of a device. coupler/host/cli has what reads them; a build without
// libmodbus says that it cannot (no_live_map.cpp).
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "coupler/cli/exit.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

struct DumpWish {
  std::vector<bool> chosen;                         ///< by point
  std::optional<std::chrono::nanoseconds> every{};  ///< nullopt: once
  bool json = false;
};

/// Reads what is chosen from the device at `map.connection`, never writing to it, and prints it: once, or
/// again and again until SIGINT or SIGTERM. ok: every point was read that the map lets be read (of a
/// repetition always); failed: the device is not reachable, or some were not.
Exit dump(const Map& map, const DumpWish& wish);

}  // namespace coupler::cli
