// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "coupler/map/owned_map.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// Asks a node once for the map that it serves, and waits for `where.timeout` at most for each answer.
/// bad_input: a foreign coupler, or a map that does not load; failed: the network, or no libmodbus.
tl::expected<MapPtr, Failure> fetch_live_map(const Connection& where);

/// Does the same. Returns nullptr for a foreign coupler, also for one that is there and does not answer such
/// a question.
tl::expected<MapPtr, Failure> fetch_map_if_node(const Connection& where);

}  // namespace coupler::tools
