// SPDX-License-Identifier: Apache-2.0
// Messages of points with a scale: what they publish is a Float64, whatever the device holds.
#pragma once

#include "coupler/codec/scale.hpp"
#include "coupler/host/ros/array_message.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::host {

/// M: std_msgs' Float64.
template <class M>
struct ScaledMessage {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.data = codec::published(registers, point.format, point.scale);
  }
  static std::string encode(const Message& message, const Point& point, std::uint16_t* registers) {
    return encode_scaled(message.data, point, registers);
  }
};

/// M: std_msgs' Float64MultiArray.
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

}  // namespace coupler::host
