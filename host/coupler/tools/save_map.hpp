// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// Writes the map of the node at `where` as the node serves it, byte for byte: to the file `out`, or to
/// standard output if that names no file. Says on standard error which map it is, and what can be done with
/// it.
Exit save_map(std::string_view command, const std::string& out, const Map& map, const Connection& where);

}  // namespace coupler::tools
