// SPDX-License-Identifier: Apache-2.0
// From settings to devices: which maps there are, and what holds for each.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/options.hpp"
#include "coupler/host/ros/settings.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::host {

/// The map of a device, and what keeps it alive (a built-in one needs nothing).
struct MapSource {
  MapPtr owner;
  Map map;
};

/// Finds the maps: the built-in one, those of the files that the settings name (at least one), or, if they
/// name an address only, the one that the node there serves. That one is waited for until
/// Shutdown::requested. Errors and waits are logged; the error is the exit code, 0 after a shutdown. The maps
/// may view the settings. A `node` that is there already gets an entry in its diagnostics for a map that is
/// waited for, and publishes them meanwhile; otherwise null.
tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings,
                                                    const Dialect& dialect,
                                                    const std::function<void(Level, const std::string&)>& log,
                                                    Node* node);

/// Returns whether a node must be asked for the map.
bool is_map_of_a_node(const Map* built_in, const Settings& settings);

std::vector<std::string_view> names_of(const std::vector<MapSource>& sources);

/// A device as it is to be driven. The map views the settings.
struct DeviceConfig {
  Settings settings;
  MapSource source;
};
using Devices = std::deque<DeviceConfig>;  // not a vector: each stays where it is

/// `settings_of(NAME)` returns what holds for the device: parameters, and arguments over them.
tl::expected<Devices, std::string> configure(
    std::vector<MapSource> sources,
    const std::function<tl::expected<Settings, std::string>(std::string_view name)>& settings_of);

}  // namespace coupler::host
