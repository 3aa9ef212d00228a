// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/provenance.hpp"

namespace coupler::generate {

/// NAME_node.cpp: the main of a node that serves coupler::maps::NAME::map.
std::string node_program(const Provenance& provenance);

/// NAME_driver.cpp: the main of the ROS driver for it.
std::string driver_program(const Provenance& provenance);

}  // namespace coupler::generate
