// SPDX-License-Identifier: Apache-2.0
// The value of a point as a C++ type without heap: bool, std::intN_t, std::uintN_t, float, double (also
// of every point with a scale, in its units), Text, or std::array of one of them. Registers are
// range(point).count() of them; bit tables give each bit as one register, 0 or 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/map/point.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler {

/// The text of a STRING, as UTF-8; `Size` is its codec::max_text_size().
template <std::size_t Size>
struct Text {
  std::array<char, Size> bytes;
  std::size_t size = 0;

  operator std::string_view() const { return {bytes.data(), size}; }
};

/// `decode` gives the value in the registers. `encode` writes it and leaves other bits of a shared register
/// alone; false if the point cannot hold it, then nothing was written.
template <class T>
struct PlainValue {
  static T decode(const std::uint16_t* registers, const Point& point) {
    return codec::take<T>(point.format, registers);
  }
  static bool encode(T value, const Point& point, std::uint16_t* registers) {
    if (!codec::has_room(value, point.format)) return false;
    codec::put(value, point.format, registers);
    return true;
  }
};

template <>
struct PlainValue<bool> {
  static bool decode(const std::uint16_t* registers, const Point& point) {
    if (holds_bits(point.table)) return registers[0] != 0;
    return codec::take<std::uint8_t>(point.format, registers) != 0;
  }
  static bool encode(bool value, const Point& point, std::uint16_t* registers) {
    if (holds_bits(point.table))
      registers[0] = value ? 1 : 0;
    else
      codec::put(static_cast<std::uint8_t>(value), point.format, registers);
    return true;
  }
};

template <>
struct PlainValue<double> {
  static double decode(const std::uint16_t* registers, const Point& point) {
    if (point.scale.present()) return codec::published(registers, point.format, point.scale);
    return codec::take<double>(point.format, registers);
  }
  static bool encode(double value, const Point& point, std::uint16_t* registers) {
    if (point.scale.present())
      return codec::encode_published(value, point.format, point.scale, registers) == codec::ScaleError::none;
    codec::put(value, point.format, registers);
    return true;
  }
};

template <>
struct PlainValue<std::string_view> {
  static bool encode(std::string_view value, const Point& point, std::uint16_t* registers) {
    return codec::encode_text(value, point.format, registers) == codec::TextError::none;
  }
};

template <std::size_t Size>
struct PlainValue<Text<Size>> : PlainValue<std::string_view> {
  static Text<Size> decode(const std::uint16_t* registers, const Point& point) {
    Text<Size> text;
    text.size = codec::decode_text(registers, point.format, text.bytes.data());
    return text;
  }
};

/// The values of an array, each as Value<T>, which may be PlainValue or TypedValue, has it.
template <template <class> class Value, class T, std::size_t Count>
std::array<T, Count> decode_each(const std::uint16_t* registers, const Point& point) {
  const std::size_t width = codec::registers(point.format);
  std::array<T, Count> values;
  for (std::size_t i = 0; i < Count; ++i) values[i] = Value<T>::decode(registers + i * width, point);
  return values;
}

template <class T, std::size_t Count>
struct PlainValue<std::array<T, Count>> {
  static std::array<T, Count> decode(const std::uint16_t* registers, const Point& point) {
    return decode_each<coupler::PlainValue, T, Count>(registers, point);
  }
  static bool encode(const std::array<T, Count>& values, const Point& point, std::uint16_t* registers) {
    std::array<std::uint16_t, modbus::max_read_registers> tried{};  // the longest STRING has as many
    for (const T& value : values)
      if (!PlainValue<T>::encode(value, point, tried.data())) return false;
    const std::size_t width = codec::registers(point.format);
    for (std::size_t i = 0; i < Count; ++i)
      (void)PlainValue<T>::encode(values[i], point, registers + i * width);
    return true;
  }
};

}  // namespace coupler
