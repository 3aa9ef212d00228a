// SPDX-License-Identifier: Apache-2.0
// Physical values <-> the registers of an analogue point.
#pragma once

#include <cstdint>

#include "common/map/point.hpp"

namespace coupler::node {

/// What the point's registers say: raw × gain + offset. Not finite if a REAL or LREAL is not.
double value_in(const Point& point, const std::uint16_t* registers);

/// Writes the nearest value that the point's type can hold and leaves other bits of a shared register alone.
/// `value` is finite.
void put_value(double value, const Point& point, std::uint16_t* registers);

}  // namespace coupler::node
