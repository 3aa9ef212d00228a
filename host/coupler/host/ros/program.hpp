// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/map/map.hpp"

namespace coupler::host {

// The exit codes of a driver, besides 0.
constexpr int wrong_input = 1;
constexpr int wrong_call = 2;
constexpr int not_safe = 3;  ///< at the end

/// The whole of a driver program, for the ROS that it is built for: coupler_driver (without a built-in map)
/// and generated ones. Returns the exit code: 0 after SIGINT or SIGTERM, 1 the map or a parameter is wrong, 2
/// the call is wrong, 3 an output should have its safe value at the end and has not.
int main_with(const Map* built_in, int argc, char** argv);

}  // namespace coupler::host
