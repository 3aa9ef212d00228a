// SPDX-License-Identifier: Apache-2.0
// The value of a point as a C++ type: as in plain_value.hpp, with std::string as UTF-8 in place of Text, and
// with a text that says what is wrong with a value.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "coupler/codec/text.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/plain_value.hpp"
#include "coupler/map/point.hpp"
#include "coupler/map/published.hpp"

namespace coupler {

/// One value of a point with a scale, into its registers. Returns what is wrong and what would be right, in
/// the point's units, or an empty text; then nothing was written.
std::string encode_scaled(double value, const Point& point, std::uint16_t* registers);

/// The same for UTF-8 `text` and a STRING.
std::string encode_string(std::string_view text, const Point& point, std::uint16_t* registers);

/// Returns why a value does not fit into the bits of its point, and which values do.
std::string no_room_text(std::uint64_t value, const Point& point);

/// Returns which part of its register the point has: "bit 3", "bits 8 to 11", "high byte". Empty if it has
/// whole registers, or stands in a table of bits.
std::string part_text(const Point& point);

/// Returns what may be written to a number: "0 to 10 bar", "idle (0) or running (1)".
std::string allowed_text(const Point& point);

/// Returns why the value is forbidden: "12 bar is above the maximum".
std::string forbidden_text(const Point& point, const ForbiddenValue& value);

/// `decode` gives the value in the registers. `encode` writes it, leaves other bits of a shared register
/// alone, and returns what is wrong and what would be right, or an empty text.
template <class T>
struct TypedValue : PlainValue<T> {
  static std::string encode(T value, const Point& point, std::uint16_t* registers) {
    if (PlainValue<T>::encode(value, point, registers)) return {};
    return no_room_text(static_cast<std::uint64_t>(value), point);  // only an unsigned integer may have none
  }
};

template <>
struct TypedValue<double> : PlainValue<double> {
  /// `registers`: host_registers(point) of them.
  static double decode(const std::uint16_t* registers, const Point& point) {
    return point.scale.present() ? published(registers, point) : PlainValue<double>::decode(registers, point);
  }
  static std::string encode(double value, const Point& point, std::uint16_t* registers) {
    if (point.scale.present()) return encode_scaled(value, point, registers);
    (void)PlainValue<double>::encode(value, point, registers);
    return {};
  }
};

template <>
struct TypedValue<std::string> {
  static std::string decode(const std::uint16_t* registers, const Point& point) {
    std::string text;
    codec::decode_text(registers, point.format, text);
    return text;
  }
  static std::string encode(std::string_view value, const Point& point, std::uint16_t* registers) {
    return encode_string(value, point, registers);
  }
};

template <class T, std::size_t Count>
struct TypedValue<std::array<T, Count>> {
  static std::array<T, Count> decode(const std::uint16_t* registers, const Point& point) {
    return decode_each<coupler::TypedValue, T, Count>(registers, point);
  }
  static std::string encode(const std::array<T, Count>& values, const Point& point,
                            std::uint16_t* registers) {
    const std::size_t width = codec::registers(point.format);
    for (std::size_t i = 0; i < Count; ++i)
      if (auto wrong = TypedValue<T>::encode(values[i], point, registers + i * width); !wrong.empty())
        return wrong;
    return {};
  }
};

}  // namespace coupler
