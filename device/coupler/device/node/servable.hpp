// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "coupler/device/net/allow_list.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// Who may connect, as the map says. The error names what is not an address.
tl::expected<AllowList, std::string> allow_list_of(const Map& map);

/// Whether a node can serve this map, which is stricter than a map of somebody else's coupler. The error says
/// which points are in the way, one a line, and what to do.
tl::expected<void, std::string> check_servable(const Map& map);

}  // namespace coupler::device
