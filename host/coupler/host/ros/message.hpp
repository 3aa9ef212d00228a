// SPDX-License-Identifier: Apache-2.0
// Which ROS message carries a point. A kind of message has a type Message and
//   decode(registers, point, message): bit tables give each bit as one register, 0 or 1; no allocation once
//   the message has been filled before;
//   encode(message, point, registers): returns what is wrong with the value and what to do, or an empty
//   text; fills range(point).count() registers, which were zero.
#pragma once

#include "coupler/host/ros/array_message.hpp"
#include "coupler/host/ros/scaled_message.hpp"
#include "coupler/host/ros/value_message.hpp"

namespace coupler::host {

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
