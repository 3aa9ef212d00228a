// SPDX-License-Identifier: Apache-2.0
// Messages of points that hold one value; M is the type in std_msgs. message.hpp says what every kind of
// message offers.
#pragma once

#include <string>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/map/point.hpp"

namespace coupler::host {

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
    codec::put(static_cast<T>(message.data), point.format, registers);
    return {};
  }
};

template <class M>
struct TextMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    codec::decode_text(registers, point.format, message.data);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    const codec::Format& format = point.format;
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

}  // namespace coupler::host
