// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "coupler/map/point.hpp"

namespace coupler::host {

/// The value in those registers, as TypedValue takes them: a bool, number or string, or a list of them. What
/// JSON has no number for (NaN, the infinities) is null.
nlohmann::ordered_json value_json(const std::uint16_t* registers, const Point& point);

}  // namespace coupler::host
