// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/stamp.hpp"

namespace coupler::generate {

/// NAME_node.cpp: the main of a node that serves coupler::maps::NAME::map.
std::string node_program(const Stamp& stamp);

/// NAME_driver.cpp: the main of the ROS driver for it.
std::string driver_program(const Stamp& stamp);

}  // namespace coupler::generate
