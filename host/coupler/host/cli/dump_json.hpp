// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/host/cli/snapshot.hpp"

namespace coupler::cli {

/// A look at a device as one line of JSON. docs/commands.md holds the fields as a table.
std::string dump_json(const Map& map, const Snapshot& now);

}  // namespace coupler::cli
