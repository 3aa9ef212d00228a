// SPDX-License-Identifier: Apache-2.0
// Times and durations in messages: ROS 1 and ROS 2 have other names for their parts.
#pragma once

#include <chrono>
#include <cstdint>

namespace coupler::host {

namespace detail {

template <class T>
auto put(T& time, std::int64_t seconds, std::int64_t rest) -> decltype(void(time.nanosec)) {
  time.sec = static_cast<decltype(time.sec)>(seconds);
  time.nanosec = static_cast<decltype(time.nanosec)>(rest);
}
template <class T>
auto put(T& time, std::int64_t seconds, std::int64_t rest) -> decltype(void(time.nsec)) {
  time.sec = static_cast<decltype(time.sec)>(seconds);
  time.nsec = static_cast<decltype(time.nsec)>(rest);
}

template <class T>
auto rest_of(const T& time) -> decltype(std::int64_t{time.nanosec}) {
  return time.nanosec;
}
template <class T>
auto rest_of(const T& time) -> decltype(std::int64_t{time.nsec}) {
  return time.nsec;
}

}  // namespace detail

/// `time`: a point in time of a message.
template <class T>
void put_time(T& time, std::chrono::nanoseconds at) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(at);
  detail::put(time, seconds.count(), (at - seconds).count());
}

/// `time`: a point in time or a duration of a message.
template <class T>
std::chrono::nanoseconds message_time(const T& time) {
  return std::chrono::seconds(time.sec) + std::chrono::nanoseconds(detail::rest_of(time));
}

}  // namespace coupler::host
