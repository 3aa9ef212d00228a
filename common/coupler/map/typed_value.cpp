// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/typed_value.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"

namespace coupler {

std::string encode_scaled(double value, const Point& point, std::uint16_t* registers) {
  const auto [least, most] = codec::published_range(point.format.type, point.scale);
  const std::string units = point.units.empty() ? "" : fmt::format(" {}", point.units);
  switch (codec::encode_published(value, point.format, point.scale, registers)) {
    case codec::ScaleError::not_a_number:
      return fmt::format("not a number; send {:g} to {:g}{}", least, most, units);
    case codec::ScaleError::out_of_range:
      return fmt::format("{:g}{} is out of range; send {:g} to {:g}{}", value, units, least, most, units);
    case codec::ScaleError::none: break;
  }
  return {};
}

std::string encode_string(std::string_view text, const Point& point, std::uint16_t* registers) {
  switch (codec::encode_text(text, point.format, registers)) {
    case codec::TextError::too_long:
      return fmt::format("'{}' is too long; give at most {} bytes of {}", text, point.format.length,
                         codec::to_string(point.format.encoding));
    case codec::TextError::not_encodable:
      return fmt::format("'{}' cannot be written in {}; leave out what it does not have", text,
                         codec::to_string(point.format.encoding));
    case codec::TextError::none: break;
  }
  return {};
}

}  // namespace coupler
