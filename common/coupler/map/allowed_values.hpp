// SPDX-License-Identifier: Apache-2.0
// Which values may be written to a point, by its keys `min`, `max`, `values`, `invalid` and
// `allow_nonfinite`, and which that are read are none. No heap, no exceptions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/map/point.hpp"

namespace coupler {

/// The rule that forbids a value.
enum class Forbidden : std::uint8_t { nonfinite, below_min, above_max, unnamed, invalid };

/// The map says which values may be written; otherwise all that the type can hold may be, if they are finite.
constexpr bool limits_values(const Point& point) {
  return point.bounds.min != Bounds::no_min || point.bounds.max != Bounds::no_max || !point.values.empty();
}

/// The map forbids values that the type can hold.
constexpr bool forbids_values(const Point& point) { return limits_values(point) || !point.invalid.empty(); }

/// Why one value, codec::registers(point.format) registers, must not be written; nullopt: it may be. A bound
/// is the value of the point that is nearest to it, so that 21.7 is not above `max: 21.7` of a REAL.
std::optional<Forbidden> why_forbidden(const Point& point, const std::uint16_t* registers);

/// The first value of the point, range(point).count() registers, that must not be written.
struct ForbiddenValue {
  Forbidden why;
  const std::uint16_t* registers;
};
std::optional<ForbiddenValue> find_forbidden(const Point& point, const std::uint16_t* registers);

/// Returns the bits of one value, see RawRange.
std::uint64_t raw_value(const codec::Format& format, const std::uint16_t* registers);

/// Returns whether this one value is one of Point::invalid.
bool is_invalid_element(const Point& point, const std::uint16_t* registers);

/// Returns whether the point has no value, because one of Point::invalid is in these registers: all of the
/// point's, as they were read, with the bits of other points. An array has none if one of its elements has
/// none.
bool is_invalid(const Point& point, const std::uint16_t* registers);

/// Returns whether a raw number of the point is beyond Point::faults.
bool is_fault(const Point& point, const std::uint16_t* registers);

/// Returns the name of the value in these registers; empty if the map has none.
std::string_view name_of_value(const Point& point, const std::uint16_t* registers);

}  // namespace coupler
