// SPDX-License-Identifier: Apache-2.0
// What the commands ask of a device. The program links coupler/host/cli, which asks over libmodbus, or
// without_libmodbus.cpp, which says that it cannot.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/cli/commands.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::cli {

/// Why there is no map, for people: what, then what to do.
struct NoLiveMap {
  Exit exit;
  std::string what;
  std::string remedy;
};

/// Asks a node once for the map that it serves, and waits for `where.timeout` at most for each answer.
/// bad_input: a foreign coupler, or a map that does not load; failed: the network, or no libmodbus.
tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& where);

struct DumpOptions {
  std::vector<bool> chosen;                         ///< by point
  std::optional<std::chrono::nanoseconds> every{};  ///< nullopt: once
  bool json = false;
};

/// Reads the chosen points from the device at `map.connection` and prints them: once, or again and again
/// until SIGINT or SIGTERM. Never writes to the device. ok: every readable point was read, or the reading was
/// repeated; failed: the device is not reachable, or some points were not read.
Exit dump(const Map& map, const DumpOptions& options);

}  // namespace coupler::cli
