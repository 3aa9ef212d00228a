// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/provenance.hpp"
#include "coupler/map/map.hpp"

namespace coupler::generate {

/// NAME_map.hpp: declares coupler::maps::NAME::map.
std::string table_header(const Map& map, const Provenance& provenance);

/// NAME_map.cpp: everything the map has, as constant data.
std::string table_source(const Map& map, const Provenance& provenance);

}  // namespace coupler::generate
