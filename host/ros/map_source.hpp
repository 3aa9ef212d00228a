// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/map/owned_map.hpp"
#include "host/ros/settings.hpp"

namespace coupler::driver {

/// The map to drive, and what keeps it alive (a built-in one needs nothing).
struct MapSource {
  MapPtr owner;
  Map map;
};

/// The built-in map, the maps of the files that the settings name (at least one), or, where they name an
/// address only, the map that the node there serves: it is waited for. Prints why there is none; the error is
/// the exit code. What is found may view the settings.
tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings);

}  // namespace coupler::driver
