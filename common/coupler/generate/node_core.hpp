// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/provenance.hpp"
#include "coupler/map/map.hpp"

namespace coupler::generate {

/// NAME_core.hpp: the class coupler::maps::NAME::NodeCore, the node of a microcontroller, in static memory of
/// the size that the map needs.
std::string node_core(const Map& map, const Provenance& provenance);

}  // namespace coupler::generate
