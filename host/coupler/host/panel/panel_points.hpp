// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler::host {

/// What the page's table says of a device and each point besides its value: JSON. `writes`: the page writes,
/// too. `warning`: is shown at the top; may be empty.
std::string panel_points(const Map& map, bool writes, std::string_view warning);

}  // namespace coupler::host
