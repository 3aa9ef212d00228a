// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/axis_value.hpp"

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coupler/codec/value.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::host {
namespace {

/// Both are exact as a double. Larger numbers do not fit into the type.
constexpr double below_int64 = -9223372036854775808.0;
constexpr double above_uint64 = 18446744073709551616.0;

/// Returns what is wrong; empty if it was written.
std::string encode_integer(const Point& point, double position, std::uint16_t* registers) {
  const double whole = std::round(position);
  if (!(whole >= below_int64 && whole < above_uint64))
    return fmt::format("{} does not fit into {}", position, to_string(point.format.type));
  const codec::Value value = whole < 0 ? codec::Value(static_cast<std::int64_t>(whole))
                                       : codec::Value(static_cast<std::uint64_t>(whole));
  const auto written = codec::encode(value, point.format, registers);
  return written ? std::string() : written.error();
}

std::string encode_number(const Point& point, double position, std::uint16_t* registers) {
  if (point.scale.present()) return encode_scaled(position, point, registers);
  switch (point.format.type) {
    case codec::Type::REAL:
      if (std::abs(position) > std::numeric_limits<float>::max())
        return fmt::format("{} does not fit into {}", position, to_string(point.format.type));
      return TypedValue<float>::encode(static_cast<float>(position), point, registers);
    case codec::Type::LREAL: return TypedValue<double>::encode(position, point, registers);
    default: return encode_integer(point, position, registers);
  }
}

}  // namespace

AxisRegisters encode_value(const Point& point, std::int64_t value) {
  AxisRegisters registers{};
  if (point.format.type == codec::Type::BOOL)
    (void)PlainValue<bool>::encode(value != 0, point, registers.data());
  else
    (void)codec::encode(codec::Value(value), point.format, registers.data());
  return registers;
}

tl::expected<AxisRegisters, std::string> encode_position(const Point& point, double position) {
  AxisRegisters registers{};
  if (auto wrong = encode_number(point, position, registers.data()); !wrong.empty())
    return tl::unexpected(std::move(wrong));
  if (const auto forbidden = find_forbidden(point, registers.data()))
    return tl::unexpected(fmt::format("{}; send {}", forbidden_text(point, *forbidden), allowed_text(point)));
  return registers;
}

std::optional<double> position_in(const std::uint16_t* registers, const Axis& axis, const Point& point) {
  if (point.format.type == codec::Type::BOOL) {
    const std::int64_t value = PlainValue<bool>::decode(registers, point) ? 1 : 0;
    for (const AxisPosition& known : axis.positions)
      if (known.value == value) return known.position;
    return std::nullopt;
  }
  if (point.scale.present()) return published(registers, point);
  const auto as_double = [](const auto& value) -> double {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) return static_cast<double>(value);
    return 0;  // a text, which no axis has
  };
  const codec::Value value = codec::decode(registers, point.format);
  if (axis.positions.empty()) return std::visit(as_double, value);
  const auto is = [&value](std::int64_t wanted) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) return *number == wanted;
    const auto* number = std::get_if<std::uint64_t>(&value);
    return number != nullptr && wanted >= 0 && *number == static_cast<std::uint64_t>(wanted);
  };
  for (const AxisPosition& known : axis.positions)
    if (is(known.value)) return known.position;
  return std::nullopt;
}

}  // namespace coupler::host
