// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/formats/importers.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::formats {

struct ImportOptions {
  std::string name;              ///< of the map; empty: the file's own, else made from the file's name
  std::optional<unsigned> unit;  ///< only this one; for a file that does not say any, the map's unit
};

struct ImportedMap {
  std::optional<unsigned> unit;
  std::string text;  ///< a file that the loader takes
  MapPtr map;
};

struct ImportResult {
  std::vector<ImportedMap> maps;  ///< one a unit; none if there are errors
  Diagnostics diagnostics;        ///< errors, and as warnings what was mended or could not be carried over
};

/// Reads the text of a foreign file; `file` names it in the diagnostics. Never throws.
ImportResult import_text(const Importer& importer, std::string_view text, std::string_view file,
                         const ImportOptions& options);

}  // namespace coupler::formats
