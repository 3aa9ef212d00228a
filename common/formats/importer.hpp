// SPDX-License-Identifier: Apache-2.0
// What a foreign format must bring to be imported: one function, and its row in importers.cpp.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "common/base/span.hpp"
#include "common/map/loader/entry.hpp"
#include "common/map/loader/problems.hpp"

namespace coupler::formats {

/// One device of a foreign file, as the tree that a map's own file would give: the loader's keys, zero-based
/// addresses, and at every entry its place in the foreign file, so that whatever the loader finds wrong is
/// told there. It need not have a name, and its points' names need not be valid.
struct ForeignUnit {
  std::optional<unsigned> unit;  ///< nullopt: the file does not say
  loader::Entry map;
};

/// Reads UTF-8 text without control characters or byte order mark. What makes it useless is an error, what
/// the map cannot say is a warning, each in its place. Never throws.
using ReadForeign = std::vector<ForeignUnit> (*)(std::string_view text, loader::Problems& problems);

struct Importer {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  ReadForeign read;
};

/// All of them; what was left out of the build is not there.
Span<const Importer> importers();

/// The importer of that name, or nullptr.
const Importer* find_importer(std::string_view name);

}  // namespace coupler::formats
