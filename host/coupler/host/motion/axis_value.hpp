// SPDX-License-Identifier: Apache-2.0
// The position of an axis as the value of its point, and back.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "coupler/map/map.hpp"

namespace coupler::host {

/// The registers of one value, in the form of Point::initial. No number has more than four.
using AxisRegisters = std::array<std::uint16_t, 4>;

/// Encodes one of Axis::positions, which the loader has checked.
AxisRegisters encode_value(const Point& point, std::int64_t value);

/// Encodes a position of an axis that has no Axis::positions: the value that the point then has, of an
/// integer the nearest one. The error says why the point may not have it, and what may be sent.
tl::expected<AxisRegisters, std::string> encode_position(const Point& point, double position);

/// Returns the position that an axis has with these host_registers(point) registers; nothing if
/// Axis::positions lacks their value.
std::optional<double> position_in(const std::uint16_t* registers, const Axis& axis, const Point& point);

}  // namespace coupler::host
