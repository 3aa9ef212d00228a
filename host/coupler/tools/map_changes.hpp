// SPDX-License-Identifier: Apache-2.0
// What a new version of a map means for those who use the old one. docs/diff.md has every rule in a table.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::tools {

/// The worst first.
enum class Severity : std::uint8_t {
  breaking,      ///< a driver with the old map refuses a node with the new one: is_breaking()
  meaning,       ///< both sides agree on the registers, and a value means something else: mm, then inches
  compatible,    ///< something behaves in another way, and both sides still agree
  documentation  ///< only what people read
};

constexpr std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::breaking: return "breaking";
    case Severity::meaning: return "meaning";
    case Severity::compatible: return "compatible";
    case Severity::documentation: return "documentation";
  }
  return "?";
}

/// One difference between two maps.
struct Change {
  std::string rule;  ///< "address-moved": stable, for scripts
  Severity severity;
  std::string point;  ///< or the tool, if the rule is of tools; empty: of the map as a whole
  std::string older;  ///< as text; empty: there was none
  std::string newer;
};

/// Returns every difference: of the map as a whole and of its tools, then of the points in the order of the
/// old map, then the added points. Points and tools are matched by name. If one is gone and a new one of its
/// type is in its place, the point is renamed. One of the changes is breaking exactly if !is_subset(older,
/// newer).
std::vector<Change> compare(const Map& older, const Map& newer);

/// Returns the worst severity of the changes, or nullopt if there are none.
std::optional<Severity> worst(const std::vector<Change>& changes);

}  // namespace coupler::tools
