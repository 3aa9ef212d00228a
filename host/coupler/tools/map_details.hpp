// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/tools/map_changes.hpp"

namespace coupler::tools {

/// One thing that a map says and that the fingerprint does not contain, besides the keys of
/// coupler/map/fields.hpp.
struct Detail {
  std::string_view rule;  ///< what a change of it is called
  Severity severity;      ///< not breaking
  std::string value;      ///< as text; equal texts mean the same
};

/// The same rules in the same order for every point.
std::vector<Detail> details_of(const Point& point);

/// Returns what the map says of a tool or an axis, but for its name.
std::string described(const Tool& tool);
std::string described(const Axis& axis);

/// The same rules in the same order for every map; of the map itself, not of its points, tools and axes.
std::vector<Detail> details_of(const Map& map);

}  // namespace coupler::tools
