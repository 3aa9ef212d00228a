// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "coupler/host/ros/map_source.hpp"
#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// A device as it is to be driven. The map refers to the settings' texts.
struct Configured {
  Settings settings;
  MapSource source;
};
using Devices = std::deque<Configured>;  // each stays where it is

std::vector<std::string_view> names_of(const std::vector<MapSource>& sources);

/// `settings_of(NAME)` says what holds for the device: parameters, and arguments over them.
tl::expected<Devices, std::string> configure(
    std::vector<MapSource> sources,
    const std::function<tl::expected<Settings, std::string>(std::string_view name)>& settings_of);

/// What hinders them, or an empty text.
std::string why_not(const Devices& devices);

/// `<name>_driver`: two drivers must not have one name.
std::string node_name(std::string_view map_name);
/// Of a device whose map it serves itself, as device.launch has it: "coupler_192_168_1_17_driver".
std::string node_name_by_address(const Settings& settings);

}  // namespace coupler::host
