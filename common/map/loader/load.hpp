// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/map/diagnostic.hpp"
#include "common/map/owned_map.hpp"

namespace coupler {

struct LoadResult {
  MapPtr map;               ///< null if there are errors
  Diagnostics diagnostics;  ///< in the order of the file
};

/// Reads a map from YAML or JSON text; `file` names it in the diagnostics. Every problem is reported, not the
/// first one (after a syntax error only that one). Never throws.
LoadResult load_map(std::string_view text, std::string_view file);

/// The same from a file; "-" is standard input. A file that cannot be read is a diagnostic.
LoadResult load_map_file(const std::string& path);

}  // namespace coupler
