// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// `<name>_driver`: two drivers must not have one name.
std::string node_name(std::string_view map_name);
/// Returns the name of the driver for a device that serves its map itself, as device.launch has it:
/// "coupler_192_168_1_17_driver".
std::string node_name_by_address(const Settings& settings);

}  // namespace coupler::host
