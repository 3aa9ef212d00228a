// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/host/ros/configuration.hpp"
#include "coupler/host/ros2/parameter_server.hpp"

namespace coupler::host {

/// Declares every setting as a parameter, with what has been given.
void show_settings(ParameterServer& server, const Settings& settings);

/// What holds, once the maps are known: of a single device each setting, of several those of each below its
/// name.
void show_devices(ParameterServer& server, const Devices& devices);

}  // namespace coupler::host
