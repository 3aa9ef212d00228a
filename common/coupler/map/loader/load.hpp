// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler {

/// The purpose for which the lock of a map is read.
enum class LockUse {
  read,   ///< to serve the map or to generate from it: a point whose address it does not know is an error
  exact,  ///< to make sure that it is up to date: the same, and it is an error if `renew` would change it
  renew   ///< to be brought up to date: such a point gets an address
};

/// The lock beside a map (coupler/map/lock/lock.hpp).
struct LockFile {
  std::string path;                 ///< as messages call it; empty: the map is no file, so it can have none
  std::optional<std::string> text;  ///< nullopt: there is none
  LockUse use = LockUse::read;
};

/// The lock that `renew` makes.
struct NewLock {
  std::string path;
  std::string text;                    ///< empty: the lock is up to date, or nothing needs one
  std::vector<std::string> allocated;  ///< points that got an address
  std::vector<std::string> retired;    ///< points that are there no more, or give an address of their own
};

struct LoadResult {
  MapPtr map;               ///< null if there are errors
  Diagnostics diagnostics;  ///< those of the lock, then in the order of the file
  NewLock lock{};           ///< what has to be written if there are no errors
  /// The line of Map::points[i] in the file, from 1. Not in the model: the layout of a file has no meaning.
  std::vector<int> point_lines{};
};

/// A larger file is refused, and not read to its end.
constexpr std::size_t max_file_size = std::size_t{16} << 20;

/// Reads a map from YAML or JSON text; `file` names it in the diagnostics. Every problem is reported, not the
/// first one (after a syntax error only that one). Never throws.
LoadResult load_map(std::string_view text, std::string_view file);

/// A map that a node serves. The node may be newer than this program: keys that are unknown here, or unknown
/// at their place, are warnings.
LoadResult load_served_map(std::string_view text, std::string_view file);

/// The same; the lock has the addresses that the map leaves out. `name`, if it is not empty, is that of a map
/// that gives none.
LoadResult load_map_with_lock(std::string_view text, std::string_view file, LockFile lock,
                              std::string_view name = {});

/// The same from a file, and from the lock beside it; "-" is standard input, which has none. A file that
/// cannot be read, or is a device, is a diagnostic. Nothing is written.
LoadResult load_map_file(const std::string& path, LockUse use = LockUse::read, std::string_view name = {});

/// Says which map beside the file that is not there has almost its name: "did you mean cell.yaml?". Empty if
/// there is none.
std::string near_file(const std::string& path);

}  // namespace coupler
