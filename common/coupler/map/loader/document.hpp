// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "coupler/map/loader/entry.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::loader {

/// The tree of a YAML or JSON text; nullopt, with the first syntax error in `problems`, if it is neither.
/// What YAML allows and a map has no use for is a syntax error too: several documents, tags, aliases, merge
/// keys, keys that are not text.
std::optional<Entry> parse_document(std::string_view text, Problems& problems);

}  // namespace coupler::loader
