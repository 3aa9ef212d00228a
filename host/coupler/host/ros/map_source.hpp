// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "coupler/host/core/sink.hpp"
#include "coupler/host/ros/dialect.hpp"
#include "coupler/host/ros/settings.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::host {

/// The map to drive, and what keeps it alive (a built-in one needs nothing).
struct MapSource {
  MapPtr owner;
  Map map;
};

/// Is told why there is no map, and what is waited for.
using Say = std::function<void(Level, const std::string&)>;

/// The built-in map, the maps of the files that the settings name (at least one), or, where they name an
/// address only, the map that the node there serves: it is waited for until Ending::asked. The error is the
/// exit code, 0 where the wait was ended. What is found may view the settings.
tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings,
                                                    const Dialect& dialect, const Say& say);

/// Whether a node must be asked for the map.
bool is_map_of_a_node(const Map* built_in, const Settings& settings);

}  // namespace coupler::host
