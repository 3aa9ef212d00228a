// SPDX-License-Identifier: Apache-2.0
// Messages of points that hold several values, or a value that is a row of bits.
#pragma once

#include <string>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/map/point.hpp"

namespace coupler::host {

/// Gives an array message its one dimension and its size; both stay from message to message.
template <class Message>
void shape(Message& message, const Point& point) {
  if (!message.layout.dim.empty()) return;
  message.layout.dim.resize(1);
  message.layout.dim[0].label = std::string(point.name);
  message.layout.dim[0].size = point.count;
  message.layout.dim[0].stride = point.count;
  message.data.resize(point.count);
}

/// What is wrong with the number of elements, or an empty text.
inline std::string wrong_size(std::size_t size, std::size_t expected, std::string_view meaning) {
  if (size == expected) return {};
  return fmt::format("{} elements; send {}{}", size, expected, meaning);
}

/// `count` integers or floats; M is one of std_msgs' MultiArrays. Of what is received its data alone counts.
template <class T, class M>
struct ArrayMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    shape(message, point);
    const std::size_t width = codec::registers(point.format);
    for (std::size_t i = 0; i < point.count; ++i)
      message.data[i] = codec::take<T>(point.format, registers + i * width);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    if (auto wrong = wrong_size(message.data.size(), point.count, ""); !wrong.empty()) return wrong;
    const std::size_t width = codec::registers(point.format);
    for (std::size_t i = 0; i < point.count; ++i)
      codec::put(static_cast<T>(message.data[i]), point.format, registers + i * width);
    return {};
  }
};

/// `count` coils or discrete inputs. M: coupler_driver/BoolArray, whose data is bytes in ROS 1 and
/// std::vector<bool> in ROS 2.
template <class M>
struct BoolsMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.data.resize(point.count);
    for (std::size_t i = 0; i < point.count; ++i) message.data[i] = registers[i] != 0;
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    if (auto wrong = wrong_size(message.data.size(), point.count, ""); !wrong.empty()) return wrong;
    for (std::size_t i = 0; i < point.count; ++i) registers[i] = message.data[i] ? 1 : 0;
    return {};
  }
};

/// BYTE … LWORD, one or `count` of them: element i is bit i of T, those of the next value follow.
template <class T, class M>
struct BitsMessage {
  using Message = M;
  static constexpr std::size_t bits = 8 * sizeof(T);

  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.data.resize(point.count * bits);
    auto out = message.data.begin();
    for (std::size_t n = 0; n < point.count; ++n, registers += codec::registers(point.format)) {
      const T value = codec::take<T>(point.format, registers);
      for (std::size_t i = 0; i < bits; ++i) *out++ = (value >> i & 1U) != 0;
    }
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    if (auto wrong = wrong_size(message.data.size(), point.count * bits, ", element i is bit i");
        !wrong.empty())
      return wrong;
    auto in = message.data.begin();
    for (std::size_t n = 0; n < point.count; ++n, registers += codec::registers(point.format)) {
      T value = 0;
      for (std::size_t i = 0; i < bits; ++i)
        if (*in++) value = static_cast<T>(value | T{1} << i);
      codec::put(value, point.format, registers);
    }
    return {};
  }
};

}  // namespace coupler::host
