// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "common/map/loader/context.hpp"
#include "common/map/loader/entry.hpp"

namespace coupler::loader {

/// Reads the whole map and finishes context.map, unless there were errors. `text` is the file.
void read_map(const Entry& root, std::string_view text, Context& context);

}  // namespace coupler::loader
