// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "coupler/map/owned_map.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// Returns the map that a node serves. Asks for it once. Waits at most `where.timeout` for each answer,
/// and no less than usual: a piece of a map is longer than what a scan asks for.
/// The exit status of a failure is bad_input for a foreign coupler or a map that does not load, and failed
/// for the network or a build without libmodbus.
tl::expected<MapPtr, Failure> fetch_live_map(Connection where);

/// Does the same, but returns nullptr for a foreign coupler, and for a device that can be reached but does
/// not answer the question.
tl::expected<MapPtr, Failure> fetch_map_if_node(const Connection& where);

}  // namespace coupler::tools
