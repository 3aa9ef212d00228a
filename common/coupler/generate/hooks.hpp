// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/provenance.hpp"
#include "coupler/map/map.hpp"

namespace coupler::generate {

/// NAME_hooks.hpp: the class coupler::maps::NAME::NodeHooks, which a firmware derives from to put its own
/// code behind the points.
std::string node_hooks(const Map& map, const Provenance& provenance);

}  // namespace coupler::generate
