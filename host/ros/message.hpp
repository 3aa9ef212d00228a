// SPDX-License-Identifier: Apache-2.0
// Which ROS message carries which IEC type, and how it is filled from registers and back.
#pragma once

#include <coupler_driver/BoolArray.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Char.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int16.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int64.h>
#include <std_msgs/Int8.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt16.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt64.h>
#include <std_msgs/UInt8.h>

#include <string>

#include <fmt/format.h>

#include "common/codec/number.hpp"
#include "common/codec/text.hpp"
#include "common/map/point.hpp"

namespace coupler::driver {

// Each of the following has a Message type and
//   decode(registers, format, message): bit tables give their bit as one register, 0 or 1;
//   encode(message, format, registers): returns what is wrong with the value and what to do, or an empty
//   text.

struct CoilMessage {
  using Message = std_msgs::Bool;
  static void decode(const std::uint16_t* registers, const codec::Format&, Message& message) {
    message.data = registers[0] != 0;
  }
  static std::string encode(const Message& message, const codec::Format&, std::uint16_t* registers) {
    registers[0] = message.data != 0 ? 1 : 0;
    return {};
  }
};

/// Integers and floats; T is the value's type.
template <class T, class M>
struct NumberMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const codec::Format& format, Message& message) {
    if constexpr (sizeof(T) == 1)
      message.data = static_cast<T>(codec::decode_part(registers[0], format));
    else
      message.data = codec::decode<T>(registers, format.order);
  }
  static std::string encode(const Message& message, const codec::Format& format, std::uint16_t* registers) {
    if constexpr (sizeof(T) == 1)
      registers[0] = codec::encode_part(static_cast<std::uint8_t>(message.data), format);
    else
      codec::encode(static_cast<T>(message.data), format.order, registers);
    return {};
  }
};

/// BYTE … LWORD: element i is bit i of T.
template <class T>
struct BitsMessage {
  using Message = coupler_driver::BoolArray;
  static constexpr std::size_t size = 8 * sizeof(T);

  static void decode(const std::uint16_t* registers, const codec::Format& format, Message& message) {
    T value{};
    if constexpr (sizeof(T) == 1)
      value = codec::decode_part(registers[0], format);
    else
      value = codec::decode<T>(registers, format.order);
    message.data.resize(size);
    for (std::size_t i = 0; i < size; ++i) message.data[i] = static_cast<std::uint8_t>(value >> i & 1U);
  }
  static std::string encode(const Message& message, const codec::Format& format, std::uint16_t* registers) {
    if (message.data.size() != size)
      return fmt::format("{} elements; send {}, element i is bit i", message.data.size(), size);
    T value = 0;
    for (std::size_t i = 0; i < size; ++i)
      if (message.data[i] != 0) value = static_cast<T>(value | T{1} << i);
    if constexpr (sizeof(T) == 1)
      registers[0] = codec::encode_part(value, format);
    else
      codec::encode(value, format.order, registers);
    return {};
  }
};

struct TextMessage {
  using Message = std_msgs::String;
  static void decode(const std::uint16_t* registers, const codec::Format& format, Message& message) {
    codec::decode_text(registers, format, message.data);
  }
  static std::string encode(const Message& message, const codec::Format& format, std::uint16_t* registers) {
    switch (codec::encode_text(message.data, format, registers)) {
      case codec::TextError::too_long:
        return fmt::format("'{}' is longer than {} bytes; send a shorter text", message.data, format.length);
      case codec::TextError::not_encodable:
        return fmt::format("'{}' has a character that {} has not", message.data,
                           codec::to_string(format.encoding));
      case codec::TextError::none: break;
    }
    return {};
  }
};

/// Calls f(T{}) with the message kind T of the point.
template <class F>
auto with_message(const Point& point, F&& f) {
  using codec::Type;
  switch (point.format.type) {
    case Type::BOOL:
      if (holds_bits(point.table)) return f(CoilMessage{});
      return f(NumberMessage<std::uint8_t, std_msgs::Bool>{});
    case Type::BYTE: return f(BitsMessage<std::uint8_t>{});
    case Type::WORD: return f(BitsMessage<std::uint16_t>{});
    case Type::DWORD: return f(BitsMessage<std::uint32_t>{});
    case Type::LWORD: return f(BitsMessage<std::uint64_t>{});
    case Type::SINT: return f(NumberMessage<std::int8_t, std_msgs::Int8>{});
    case Type::INT: return f(NumberMessage<std::int16_t, std_msgs::Int16>{});
    case Type::DINT: return f(NumberMessage<std::int32_t, std_msgs::Int32>{});
    case Type::LINT: return f(NumberMessage<std::int64_t, std_msgs::Int64>{});
    case Type::USINT: return f(NumberMessage<std::uint8_t, std_msgs::UInt8>{});
    case Type::UINT: return f(NumberMessage<std::uint16_t, std_msgs::UInt16>{});
    case Type::UDINT: return f(NumberMessage<std::uint32_t, std_msgs::UInt32>{});
    case Type::ULINT: return f(NumberMessage<std::uint64_t, std_msgs::UInt64>{});
    case Type::REAL: return f(NumberMessage<float, std_msgs::Float32>{});
    case Type::LREAL: return f(NumberMessage<double, std_msgs::Float64>{});
    case Type::CHAR: return f(NumberMessage<std::uint8_t, std_msgs::Char>{});
    case Type::STRING: break;
  }
  return f(TextMessage{});
}

}  // namespace coupler::driver
