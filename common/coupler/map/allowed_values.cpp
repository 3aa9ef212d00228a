// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/allowed_values.hpp"

#include <algorithm>
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

std::uint64_t raw_value(const codec::Format& format, const std::uint16_t* registers) {
  if (format.type == codec::Type::BOOL)
    return codec::bytes_swapped(format.order) ? codec::swap_bytes(registers[0]) : registers[0];
  return codec::with_number(format.type, [&](auto zero) -> std::uint64_t {
    return codec::take<typename codec::detail::Unsigned<sizeof zero>::type>(format, registers);
  });
}

bool is_invalid_element(const Point& point, const std::uint16_t* registers) {
  const std::uint64_t raw = raw_value(point.format, registers);
  return std::any_of(point.invalid.begin(), point.invalid.end(),
                     [raw](const RawRange& range) { return raw >= range.first && raw <= range.last; });
}

bool is_invalid(const Point& point, const std::uint16_t* registers) {
  if (point.invalid.empty()) return false;
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i)
    if (is_invalid_element(point, registers + i * width)) return true;
  return false;
}

bool is_fault(const Point& point, const std::uint16_t* registers) {
  if (!point.faults.present()) return false;
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i) {
    const double raw = codec::published(registers + i * width, point.format, {});
    if (point.faults.is_below(raw) || point.faults.is_above(raw)) return true;
  }
  return false;
}

/// A BOOL has `invalid` values of its register, which say nothing of a bit that is written.
std::optional<Forbidden> why_forbidden(const Point& point, const std::uint16_t* registers) {
  if (holds_bits(point.table)) return std::nullopt;
  if (point.format.type != codec::Type::BOOL && is_invalid_element(point, registers))
    return Forbidden::invalid;
  if (!codec::is_scalable(point.format.type)) return std::nullopt;
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
  if (!forbids_values(point) && !codec::is_float(point.format.type)) return std::nullopt;
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
