// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "coupler/host/core/write.hpp"

namespace coupler::host {

/// What the subscriptions of a device share.
struct WriteHandler {
  std::function<void(const Write&)> accept;
  /// The value cannot be written: the point's index, if there is such a point, what was wrong and the remedy.
  std::function<void(std::optional<std::uint32_t> point, const std::string& what)> refuse;
};

/// Hands on a message that came on the topic of `map.points[index]`; Kind: a kind of message (message.hpp).
template <class Kind>
void receive(const typename Kind::Message& message, const std::string& topic, const Map& map,
             std::uint32_t index, const WriteHandler& handler) {
  std::array<std::uint16_t, modbus::max_write_bits> values{};
  const Point& point = map.points[index];
  const std::string wrong = Kind::encode(message, point, values.data());
  if (wrong.empty())
    handler.accept(make_write(map, index, {values.data(), range(point).count()}));
  else
    handler.refuse(index, topic + ": " + wrong);
}

/// A topic of writes keeps ten times as many messages as one of values.
constexpr std::uint32_t writes_per_value = 10;

}  // namespace coupler::host
