// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/lock_file.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler {

struct LoadResult {
  MapPtr map;               ///< null if there are errors
  Diagnostics diagnostics;  ///< those of the lock, then in the order of the file
  NewLock lock{};           ///< what has to be written if there are no errors
  /// Where Map::points[i] stands in the file, from 1. Beside the model: how a file is laid out is not what a
  /// map means.
  std::vector<int> point_lines{};
};

/// A larger file is refused, without reading on: it is no map.
constexpr std::size_t max_file_size = std::size_t{16} << 20;

/// Reads a map from YAML or JSON text; `file` names it in the diagnostics. Every problem is reported, not the
/// first one (after a syntax error only that one). Never throws.
LoadResult load_map(std::string_view text, std::string_view file);

/// A map that a node serves. The node may be newer than this program: keys that are unknown here, or unknown
/// at their place, are warnings.
LoadResult load_served_map(std::string_view text, std::string_view file);

/// The same; the lock has the addresses that the map leaves out. `name`, if it is not empty, is that of a map
/// that says none.
LoadResult load_map_with_lock(std::string_view text, std::string_view file, LockFile lock,
                              std::string_view name = {});

/// The same from a file, and from the lock beside it; "-" is standard input, which has none. A file that
/// cannot be read is a diagnostic. Nothing is written.
LoadResult load_map_file(const std::string& path, LockUse use = LockUse::read, std::string_view name = {});

}  // namespace coupler
