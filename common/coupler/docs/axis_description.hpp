// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/docs/text_column.hpp"
#include "coupler/map/map.hpp"

namespace coupler::docs {

/// The texts about one axis, not yet escaped for any format.
struct AxisDescription {
  std::string name;
  std::string point;
  std::string joint;
  std::string positions;  ///< "off at 0, on at 1", "the published value"
};

/// In the order in which tables have them.
constexpr TextColumn<AxisDescription> axis_columns[] = {
    {"axis", &AxisDescription::name},
    {"point", &AxisDescription::point},
    {"joint", &AxisDescription::joint},
    {"positions", &AxisDescription::positions},
};
constexpr Span<const TextColumn<AxisDescription>> columns_of(const AxisDescription*) { return axis_columns; }

/// In the order of the map.
std::vector<AxisDescription> describe_axes(const Map& map);

}  // namespace coupler::docs
