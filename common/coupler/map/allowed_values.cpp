// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/allowed_values.hpp"

#include <cmath>

#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"

namespace coupler {
namespace {

double nearest(double bound, const Point& point) {
  return codec::nearest_published(bound, point.format, point.scale);
}

/// The integer in the registers is `value`. Integers above the range of `value` are none.
bool holds(const Point& point, const std::uint16_t* registers, std::int64_t value) {
  return codec::with_number(point.format.type, [&](auto zero) {
    using T = decltype(zero);
    const T found = codec::take<T>(point.format, registers);
    return static_cast<T>(value) == found && (found >= T{}) == (value >= 0);
  });
}

}  // namespace

std::optional<Forbidden> why_forbidden(const Point& point, const std::uint16_t* registers) {
  if (holds_bits(point.table) || !codec::is_scalable(point.format.type)) return std::nullopt;
  const Bounds& bounds = point.bounds;
  const double value = codec::published(registers, point.format, point.scale);
  if (!std::isfinite(value)) {
    if (bounds.allow_nonfinite) return std::nullopt;
    return Forbidden::nonfinite;
  }
  if (bounds.min != Bounds::no_min && value < nearest(bounds.min, point)) return Forbidden::below_min;
  if (bounds.max != Bounds::no_max && value > nearest(bounds.max, point)) return Forbidden::above_max;
  if (!point.values.empty() && name_of_value(point, registers).empty()) return Forbidden::unnamed;
  return std::nullopt;
}

std::optional<ForbiddenValue> find_forbidden(const Point& point, const std::uint16_t* registers) {
  // Each write of the driver comes here, and of most points every value may be written.
  if (!limits_values(point) && !codec::is_float(point.format.type)) return std::nullopt;
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i, registers += width)
    if (const auto why = why_forbidden(point, registers)) return ForbiddenValue{*why, registers};
  return std::nullopt;
}

std::string_view name_of_value(const Point& point, const std::uint16_t* registers) {
  for (const NamedValue& named : point.values)
    if (holds(point, registers, named.value)) return named.name;
  return {};
}

}  // namespace coupler
