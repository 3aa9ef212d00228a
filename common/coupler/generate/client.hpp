// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/generate/provenance.hpp"
#include "coupler/map/map.hpp"

namespace coupler::generate {

/// NAME_client.hpp: the class coupler::maps::NAME::Client, a member for each point.
std::string client_header(const Map& map, const Provenance& provenance);

/// NAME_client.cpp: its constructor.
std::string client_source(const Map& map, const Provenance& provenance);

}  // namespace coupler::generate
