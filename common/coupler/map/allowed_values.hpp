// SPDX-License-Identifier: Apache-2.0
// Which values may be written to a point, by its keys `min`, `max`, `values` and `allow_nonfinite`. No heap,
// no exceptions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/map/point.hpp"

namespace coupler {

/// The rule that forbids a value.
enum class Forbidden : std::uint8_t { nonfinite, below_min, above_max, unnamed };

/// The map says which values may be written; otherwise all that the type can hold may be, if they are finite.
constexpr bool limits_values(const Point& point) {
  return point.bounds.min != Bounds::no_min || point.bounds.max != Bounds::no_max || !point.values.empty();
}

/// Why one value, codec::registers(point.format) registers, must not be written; nullopt: it may be. A bound
/// is the value of the point that is nearest to it, so that 21.7 is not above `max: 21.7` of a REAL.
std::optional<Forbidden> why_forbidden(const Point& point, const std::uint16_t* registers);

/// The first value of the point, range(point).count() registers, that must not be written.
struct ForbiddenValue {
  Forbidden why;
  const std::uint16_t* registers;
};
std::optional<ForbiddenValue> find_forbidden(const Point& point, const std::uint16_t* registers);

/// Returns the name of the value in these registers; empty if the map has none.
std::string_view name_of_value(const Point& point, const std::uint16_t* registers);

}  // namespace coupler
