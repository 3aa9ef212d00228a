// SPDX-License-Identifier: Apache-2.0
// Which message carries a single value with its stamp. A kind of message is as in message.hpp, without
// encode().
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/ros/message_time.hpp"
#include "coupler/host/ros/sample.hpp"
#include "coupler/map/point.hpp"
#include "coupler/map/published.hpp"

namespace coupler::host {

/// One coil or discrete input.
template <class M>
struct StampedCoil {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point&, Message& message) {
    message.value = registers[0] != 0;
  }
};

/// A signed number as the message has it.
template <class T>
auto widened(T number) {
  if constexpr (std::is_integral_v<T> && std::is_signed_v<T>)
    return std::int64_t{number};
  else
    return number;
}

/// T is the type in the registers.
template <class T, class M>
struct StampedNumber {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.value = widened(codec::take<T>(point.format, registers));
  }
};

template <class M>
struct StampedScaled {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    message.value = published(registers, point);
  }
};

template <class M>
struct StampedText {
  using Message = M;
  static void decode(const std::uint16_t* registers, const Point& point, Message& message) {
    codec::decode_text(registers, point.format, message.value);
  }
};

/// Calls f(T{}) with the kind of message of a point that is no array. M names the message types of a ROS.
template <class M, class F>
auto with_stamped_message(const Point& point, F&& f) {
  using codec::Type;
  if (point.scale.present()) return f(StampedScaled<typename M::Float64Stamped>{});
  if (point.format.type == Type::STRING) return f(StampedText<typename M::StringStamped>{});
  if (holds_bits(point.table)) return f(StampedCoil<typename M::BoolStamped>{});
  if (point.format.type == Type::BOOL) return f(StampedNumber<std::uint8_t, typename M::BoolStamped>{});
  return codec::with_number(point.format.type, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_floating_point_v<T>)
      return f(StampedNumber<T, typename M::Float64Stamped>{});
    else if constexpr (std::is_signed_v<T>)
      return f(StampedNumber<T, typename M::Int64Stamped>{});
    else
      return f(StampedNumber<T, typename M::UInt64Stamped>{});
  });
}

/// The messages of samples in the place of the stamped ones, for with_stamped_message().
template <class M>
struct SampleMessages {
  using BoolStamped = typename M::BoolSample;
  using Float64Stamped = typename M::Float64Sample;
  using Int64Stamped = typename M::Int64Sample;
  using StringStamped = typename M::StringSample;
  using UInt64Stamped = typename M::UInt64Sample;
};

/// Fills what such a message says beside its value. The stamp does not go back, unless somebody has set the
/// clock back: a better measurement of it may find an earlier time, and what that adds to the error is said.
class Stamper {
 public:
  /// `wall` must outlive it.
  explicit Stamper(const WallTime& wall) : wall_(wall) {}

  void see(const Sample&) {}
  void forget() {}

  template <class Message>
  void operator()(Message& message, const Sample& sample) {
    const Stamp stamp = sample.stamp;
    const WallTime::Wall at = wall_.of(stamp.at);
    const bool was_set = times_set_ != wall_.times_set();
    times_set_ = wall_.times_set();
    last_ = was_set ? at : std::max(last_, at);
    put_time(message.header.stamp, last_);
    message.sequence = ++sequence_;
    message.uncertainty =
        std::chrono::duration<double>(stamp.uncertainty + wall_.error() + (last_ - at)).count();
  }

 private:
  const WallTime& wall_;
  std::uint64_t sequence_ = 0;
  WallTime::Wall last_ = WallTime::Wall::min();
  std::uint32_t times_set_ = 0;
};

/// Fills what the message of a sample says beside its value.
class SampleStamper {
 public:
  /// `wall` must outlive it.
  explicit SampleStamper(const WallTime& wall) : wall_(wall), stamper_(wall) {}
  SampleStamper(const SampleStamper& other) : wall_(other.wall_), stamper_(other.stamper_) {}
  SampleStamper& operator=(const SampleStamper&) = delete;

  /// Each value, also one that is not published.
  void see(const Sample& sample) {
    const bool is_first = is_unknown_.exchange(false);
    is_after_gap_ |= is_first;
    if (is_first || sample.is_new) since_ = sample.stamp.at;
  }
  /// The next value is known since its own stamp, whatever it is. Any thread may call it.
  void forget() { is_unknown_ = true; }

  template <class Message>
  void operator()(Message& message, const Sample& sample) {
    stamper_(message, sample);
    message.told = sample.is_told;
    message.after_gap = std::exchange(is_after_gap_, false);
    put_time(message.since, std::min(wall_.of(since_), message_time(message.header.stamp)));
  }

 private:
  const WallTime& wall_;
  Stamper stamper_;
  Time since_{};
  std::atomic<bool> is_unknown_{true};
  bool is_after_gap_ = false;
};

}  // namespace coupler::host
