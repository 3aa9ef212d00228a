// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coupler/map/loader/context.hpp"
#include "coupler/map/loader/entry.hpp"
#include "coupler/map/loader/placement.hpp"

namespace coupler::loader {

/// Reads the whole map and finishes context.map, unless there were errors. `text` is the file; points without
/// an address get theirs from `placement`.
void read_map(const Entry& root, std::string_view text, Placement& placement, Context& context);

}  // namespace coupler::loader
