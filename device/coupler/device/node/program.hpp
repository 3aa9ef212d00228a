// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/hooks.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// The whole of a node whose map is built in: options, service, exit status (0 ok, 1 the map cannot be
/// served, 2 the call is wrong, 3 network or hardware failed). Generated programs call it and nothing else.
int main_with(const Map& map, int argc, char** argv);

/// The same with a firmware's code behind the points.
int main_with(const Map& map, Hooks& hooks, int argc, char** argv);

}  // namespace coupler::device
