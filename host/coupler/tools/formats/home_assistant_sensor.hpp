// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler::formats {

/// Returns the keys of a sensor of Home Assistant that say how its registers are read, one a line behind
/// `indent`.
std::string format_keys(const Point& point, std::string_view indent);

/// Returns the raw value that means "no value" to Home Assistant, which compares that number and its negative
/// with the raw value of a whole number. nullopt: the point has none, or the negative could be a value.
std::optional<std::int64_t> nan_value_of(const Point& point);

}  // namespace coupler::formats
