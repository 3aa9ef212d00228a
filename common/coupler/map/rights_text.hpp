// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler {

/// The points that a role of the map may read or write: "all" that can be, "none", or their names.
std::string rights_text(const Map& map, const Role& role, Right right);

/// Whose rights Security::plain says: "every client", or "clients without TLS" where there are others.
std::string_view plain_clients(const Security& security);

}  // namespace coupler
