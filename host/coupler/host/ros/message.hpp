// SPDX-License-Identifier: Apache-2.0
// Which ROS message carries a point. A kind of message has a type Message and
//   decode(registers, point, message): bit tables give each bit as one register, 0 or 1; no allocation once
//   the message has been filled before;
//   encode(message, point, registers): returns what is wrong with the value and what to do, or an empty
//   text; fills range(point).count() registers, which were zero.
// M is the type of the message: of either ROS.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/map/point.hpp"
#include "coupler/map/published.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::host {

/// One coil or discrete input.
template <class M>
struct CoilMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point&, Message& message) {
    message.data = registers[0] != 0;
  }
  static std::string encode(const Message& message, const Point&, std::uint16_t* registers) {
    registers[0] = message.data != 0 ? 1 : 0;
    return {};
  }
};

/// Integers and floats; T is the value's type.
template <class T, class M>
struct NumberMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.data = codec::take<T>(point.format, registers);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    return TypedValue<T>::encode(static_cast<T>(message.data), point, registers);
  }
};

template <class M>
struct TextMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    codec::decode_text(registers, point.format, message.data);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    return encode_string(message.data, point, registers);
  }
};

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

/// Returns what is wrong with the number of elements, or an empty text.
inline std::string wrong_size(std::size_t size, std::size_t expected, std::string_view meaning) {
  if (size == expected) return {};
  return fmt::format("{} elements; send {}{}", size, expected, meaning);
}

/// `count` integers or floats; M is a MultiArray. The layout of what is received does not matter.
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
      if (std::string wrong = TypedValue<T>::encode(value, point, registers); !wrong.empty()) return wrong;
    }
    return {};
  }
};

/// A number with a scale. It is published as a Float64, whatever the device holds.
template <class M>
struct ScaledMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.data = published(registers, point);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    return encode_scaled(message.data, point, registers);
  }
};

/// `count` numbers with a scale.
template <class M>
struct ScaledArrayMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    shape(message, point);
    for (double& value : message.data) {
      value = codec::published(registers, point.format, point.scale);
      registers += codec::registers(point.format);
    }
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    std::string wrong = wrong_size(message.data.size(), point.count, "");
    for (std::size_t i = 0; i < point.count && wrong.empty(); ++i) {
      wrong = encode_scaled(message.data[i], point, registers);
      registers += codec::registers(point.format);
    }
    return wrong;
  }
};

/// Calls f(T{}) with the kind of message of the point, whose values are numbers of type T.
template <class T, class One, class Several, class F>
auto with_number_message(const Point& point, F&& f) {
  return point.count > 1 ? f(ArrayMessage<T, Several>{}) : f(NumberMessage<T, One>{});
}

/// Calls f(T{}) with the kind of message of the point. M names the message types of a ROS
/// (coupler/host/ros1/messages.hpp, coupler/host/ros2/messages.hpp).
template <class M, class F>
auto with_message(const Point& point, F&& f) {
  using codec::Type;
  if (point.scale.present())
    return point.count > 1 ? f(ScaledArrayMessage<typename M::Float64MultiArray>{})
                           : f(ScaledMessage<typename M::Float64>{});
  switch (point.format.type) {
    case Type::BOOL:
      if (point.count > 1) return f(BoolsMessage<typename M::BoolArray>{});
      if (holds_bits(point.table)) return f(CoilMessage<typename M::Bool>{});
      return f(NumberMessage<std::uint8_t, typename M::Bool>{});
    case Type::BYTE: return f(BitsMessage<std::uint8_t, typename M::BoolArray>{});
    case Type::WORD: return f(BitsMessage<std::uint16_t, typename M::BoolArray>{});
    case Type::DWORD: return f(BitsMessage<std::uint32_t, typename M::BoolArray>{});
    case Type::LWORD: return f(BitsMessage<std::uint64_t, typename M::BoolArray>{});
    case Type::SINT: return f(NumberMessage<std::int8_t, typename M::Int8>{});
    case Type::INT:
      return with_number_message<std::int16_t, typename M::Int16, typename M::Int16MultiArray>(point, f);
    case Type::DINT:
      return with_number_message<std::int32_t, typename M::Int32, typename M::Int32MultiArray>(point, f);
    case Type::LINT:
      return with_number_message<std::int64_t, typename M::Int64, typename M::Int64MultiArray>(point, f);
    case Type::USINT: return f(NumberMessage<std::uint8_t, typename M::UInt8>{});
    case Type::UINT:
      return with_number_message<std::uint16_t, typename M::UInt16, typename M::UInt16MultiArray>(point, f);
    case Type::UDINT:
      return with_number_message<std::uint32_t, typename M::UInt32, typename M::UInt32MultiArray>(point, f);
    case Type::ULINT:
      return with_number_message<std::uint64_t, typename M::UInt64, typename M::UInt64MultiArray>(point, f);
    case Type::REAL:
      return with_number_message<float, typename M::Float32, typename M::Float32MultiArray>(point, f);
    case Type::LREAL:
      return with_number_message<double, typename M::Float64, typename M::Float64MultiArray>(point, f);
    case Type::CHAR: return f(NumberMessage<std::uint8_t, typename M::Char>{});
    case Type::STRING: break;
  }
  return f(TextMessage<typename M::String>{});
}

}  // namespace coupler::host
