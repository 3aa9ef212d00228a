// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler::host {

/// Returns the JSON for the page's table: the device, and each point without its value. `writes`: the page
/// writes, too. `warning` is shown at the top, and may be empty.
std::string panel_points(const Map& map, bool writes, std::string_view warning);

}  // namespace coupler::host
