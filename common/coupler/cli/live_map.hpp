// SPDX-License-Identifier: Apache-2.0
// A port of the commands: the map that a node serves. coupler/host/cli has what fetches it; a build without
// libmodbus says that it cannot (no_live_map.cpp).
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/cli/exit.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::cli {

/// Why there is no map, for people: what, then what to do.
struct NoLiveMap {
  Exit exit;
  std::string what;
  std::string remedy;
};

/// Asks once, for `where.timeout` at most for each answer. bad_input: a foreign coupler, or a map that does
/// not load; failed: the network, or a build that has none.
tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& where);

}  // namespace coupler::cli
