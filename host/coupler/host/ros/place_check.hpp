// SPDX-License-Identifier: Apache-2.0
// What is wrong with the place of a device, as settings and map give it: a text with a remedy, or an empty
// one.
#pragma once

#include <string>

#include "coupler/host/ros/settings.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Returns what is wrong with the place of a device that is read: it has to be given once, and its unit has
/// to answer. `connection` is the result of the settings.
std::string place_error(const Settings& settings, const Connection& connection);

/// Nobody answers a broadcast, so nothing may need an answer.
std::string broadcast_error(const Map& map);

/// A setting that does nothing where `map` and settings say that the device is. One that is as in the map may
/// be among parameters that a driver has shown.
std::string useless_setting(const Settings& settings, const Map& map);

}  // namespace coupler::host
