// SPDX-License-Identifier: Apache-2.0
// Anchors, aliases and merge keys of YAML. A map does not need them, but other programs' files have them.
#pragma once

#include <cstddef>
#include <map>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {

/// The values that anchors name, and what is left of the memory that they and their copies may take: a few
/// lines of aliases of aliases would otherwise fill any memory.
class Anchors {
 public:
  /// Counts one copy of the value. False if there is no room for it.
  bool make_room_for(const Entry& value);

  /// Keeps a copy of the value. False if there is no room for it.
  bool keep(std::size_t anchor, const Entry& value);

  /// nullptr if the value is not complete: the alias then stands inside of it.
  const Entry* find(std::size_t anchor) const;

 private:
  std::map<std::size_t, Entry> values_;
  std::size_t room_ = 4 * max_text_size;  ///< bytes
};

/// Returns how many lists and maps are inside each other; 0 for a scalar.
std::size_t depth_of(const Entry& value);

/// Replaces the keys '<<' of a map by the keys of the maps that they name. The map's own keys, and those of
/// earlier maps, win. Throws a SyntaxError where '<<' has something else than maps.
void merge_keys(Entry& map);

}  // namespace coupler::loader
