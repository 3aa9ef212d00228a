// SPDX-License-Identifier: Apache-2.0
// Which ROS message carries a point. A kind of message has a type Message and
//   decode(registers, point, message): bit tables give each bit as one register, 0 or 1; no allocation once
//   the message has been filled before;
//   encode(message, point, registers): returns what is wrong with the value and what to do, or an empty
//   text; fills range(point).count() registers, which were zero.
#pragma once

#include <std_msgs/Char.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float32MultiArray.h>
#include <std_msgs/Int16.h>
#include <std_msgs/Int16MultiArray.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int64.h>
#include <std_msgs/Int64MultiArray.h>
#include <std_msgs/Int8.h>
#include <std_msgs/UInt16.h>
#include <std_msgs/UInt16MultiArray.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt32MultiArray.h>
#include <std_msgs/UInt64.h>
#include <std_msgs/UInt64MultiArray.h>
#include <std_msgs/UInt8.h>

#include "host/ros/array_message.hpp"
#include "host/ros/scaled_message.hpp"
#include "host/ros/value_message.hpp"

namespace coupler::driver {

/// Calls f(T{}) with the kind of message of the point, whose values are numbers of type T.
template <class T, class One, class Several, class F>
auto with_number_message(const Point& point, F&& f) {
  return point.count > 1 ? f(ArrayMessage<T, Several>{}) : f(NumberMessage<T, One>{});
}

/// Calls f(T{}) with the kind of message of the point.
template <class F>
auto with_message(const Point& point, F&& f) {
  using codec::Type;
  if (point.scale.present()) return point.count > 1 ? f(ScaledArrayMessage{}) : f(ScaledMessage{});
  switch (point.format.type) {
    case Type::BOOL:
      if (point.count > 1) return f(BoolsMessage{});
      if (holds_bits(point.table)) return f(CoilMessage{});
      return f(NumberMessage<std::uint8_t, std_msgs::Bool>{});
    case Type::BYTE: return f(BitsMessage<std::uint8_t>{});
    case Type::WORD: return f(BitsMessage<std::uint16_t>{});
    case Type::DWORD: return f(BitsMessage<std::uint32_t>{});
    case Type::LWORD: return f(BitsMessage<std::uint64_t>{});
    case Type::SINT: return f(NumberMessage<std::int8_t, std_msgs::Int8>{});
    case Type::INT:
      return with_number_message<std::int16_t, std_msgs::Int16, std_msgs::Int16MultiArray>(point, f);
    case Type::DINT:
      return with_number_message<std::int32_t, std_msgs::Int32, std_msgs::Int32MultiArray>(point, f);
    case Type::LINT:
      return with_number_message<std::int64_t, std_msgs::Int64, std_msgs::Int64MultiArray>(point, f);
    case Type::USINT: return f(NumberMessage<std::uint8_t, std_msgs::UInt8>{});
    case Type::UINT:
      return with_number_message<std::uint16_t, std_msgs::UInt16, std_msgs::UInt16MultiArray>(point, f);
    case Type::UDINT:
      return with_number_message<std::uint32_t, std_msgs::UInt32, std_msgs::UInt32MultiArray>(point, f);
    case Type::ULINT:
      return with_number_message<std::uint64_t, std_msgs::UInt64, std_msgs::UInt64MultiArray>(point, f);
    case Type::REAL:
      return with_number_message<float, std_msgs::Float32, std_msgs::Float32MultiArray>(point, f);
    case Type::LREAL:
      return with_number_message<double, std_msgs::Float64, std_msgs::Float64MultiArray>(point, f);
    case Type::CHAR: return f(NumberMessage<std::uint8_t, std_msgs::Char>{});
    case Type::STRING: break;
  }
  return f(TextMessage{});
}

}  // namespace coupler::driver
