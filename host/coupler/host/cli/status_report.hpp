// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/host/cli/node_status.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

/// For people, a line each. Of a foreign coupler its identification; empty if it has none. Texts of the
/// device are made harmless for a terminal.
std::string status_text(const NodeStatus& status, const Connection& where);

/// One line of JSON. docs/commands.md holds the fields as a table.
std::string status_json(const NodeStatus& status, const Connection& where);

}  // namespace coupler::cli
