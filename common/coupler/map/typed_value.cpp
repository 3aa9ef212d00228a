// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/typed_value.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/printable.hpp"

namespace coupler {
namespace {

std::string units_of(const Point& point) {
  return point.units.empty() ? "" : fmt::format(" {}", point.units);
}

/// "0 to 10 bar", "at least 0 bar".
std::string bounds_text(const Point& point) {
  const auto [min, max, nonfinite] = point.bounds;
  const std::string units = units_of(point);
  if (min == Bounds::no_min) return fmt::format("at most {:g}{}", max, units);
  if (max == Bounds::no_max) return fmt::format("at least {:g}{}", min, units);
  return fmt::format("{:g} to {:g}{}", min, max, units);
}

std::string number_text(const Point& point, const std::uint16_t* registers) {
  if (codec::is_scalable(point.format.type))
    return fmt::format("{:.15g}{}", codec::published(registers, point.format, point.scale), units_of(point));
  return codec::to_string(codec::decode(registers, point.format));
}

std::string value_names_text(const Point& point) {
  std::string text;
  for (const NamedValue& named : point.values) {
    if (!text.empty()) text += &named + 1 == point.values.end() ? " or " : ", ";
    text += fmt::format("{} ({})", named.name, named.value);
  }
  return text;
}

}  // namespace

std::string encode_scaled(double value, const Point& point, std::uint16_t* registers) {
  const auto [least, most] = codec::published_range(point.format, point.scale);
  const std::string units = units_of(point);
  const std::string right =
      limits_values(point) ? allowed_text(point) : fmt::format("{:g} to {:g}{}", least, most, units);
  switch (codec::encode_published(value, point.format, point.scale, registers)) {
    case codec::ScaleError::not_a_number: return "not a number; send " + right;
    case codec::ScaleError::out_of_range:
      return fmt::format("{:g}{} is out of range; send {}", value, units, right);
    case codec::ScaleError::none: break;
  }
  return {};
}

std::string no_room_text(std::uint64_t value, const Point& point) {
  const unsigned most = codec::largest_in(point.format.bits);
  return fmt::format("{} does not fit into {} bits; send {}", value, point.format.bits,
                     limits_values(point) ? allowed_text(point) : fmt::format("0 to {}", most));
}

std::string encode_string(std::string_view text, const Point& point, std::uint16_t* registers) {
  switch (codec::encode_text(text, point.format, registers)) {
    case codec::TextError::too_long:
      return fmt::format("{} is too long; give at most {} bytes of {}", excerpt(text), point.format.length,
                         codec::to_string(point.format.encoding));
    case codec::TextError::not_encodable:
      return fmt::format("{} cannot be written in {}; leave out what it does not have", excerpt(text),
                         codec::to_string(point.format.encoding));
    case codec::TextError::has_nul:
      return "a text with a NUL character would end there; leave the character out";
    case codec::TextError::none: break;
  }
  return {};
}

std::string forbidden_text(const Point& point, const ForbiddenValue& value) {
  const double number = codec::published(value.registers, point.format, point.scale);
  switch (value.why) {
    case Forbidden::nonfinite: return "a number that is not finite (NaN or infinity)";
    case Forbidden::below_min: return fmt::format("{:g}{} is below the minimum", number, units_of(point));
    case Forbidden::above_max: return fmt::format("{:g}{} is above the maximum", number, units_of(point));
    case Forbidden::invalid:
      return fmt::format("{} means 'no value' ('invalid' in the map)", number_text(point, value.registers));
    case Forbidden::unnamed:
      return fmt::format("{} is not one of its values",
                         codec::to_string(codec::decode(value.registers, point.format)));
  }
  return {};
}

std::string part_text(const Point& point) {
  const codec::Format& format = point.format;
  if (!is_partial(point)) return {};
  if (format.bits != 0) return fmt::format("bits {} to {}", format.bit, format.bit + format.bits - 1);
  if (format.type == codec::Type::BOOL) return fmt::format("bit {}", format.bit);
  return format.half == codec::Half::high ? "high byte" : "low byte";
}

std::string allowed_text(const Point& point) {
  if (!point.values.empty()) return value_names_text(point);
  if (limits_values(point)) return bounds_text(point);
  return point.invalid.empty() || codec::is_float(point.format.type) ? "a finite number" : "another value";
}

}  // namespace coupler
