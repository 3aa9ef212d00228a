// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace coupler {

/// Limits log lines of one kind to one an interval, and `burst` at first. What comes sooner waits; of several
/// that wait only the newest is logged, with the number of those left out. Any thread may call.
class LogLineLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr auto usual = std::chrono::seconds(1);

  explicit LogLineLimit(std::chrono::seconds interval = usual, int burst = 1)
      : interval_(interval), ahead_(interval * (burst - 1)) {}

  /// The line to log now, if any.
  std::optional<std::string> say(std::string text, Time now) {
    const std::lock_guard lock(mutex_);
    left_out_ += waiting_ ? 1 : 0;
    waiting_ = std::move(text);
    return take(now);
  }
  /// The waiting line, if its time has come.
  std::optional<std::string> due(Time now) {
    const std::lock_guard lock(mutex_);
    return take(now);
  }
  /// When due() returns a line; nullopt: none waits.
  std::optional<Time> due_at() {
    const std::lock_guard lock(mutex_);
    return waiting_ ? std::optional(next_ ? *next_ - ahead_ : Time()) : std::nullopt;
  }

 private:
  std::optional<std::string> take(Time now) {
    if (!waiting_ || (next_ && *next_ - now > ahead_)) return std::nullopt;
    next_ = std::max(next_.value_or(now), now) + interval_;
    if (left_out_ > 0) *waiting_ += fmt::format(" (and {} more of this kind)", std::exchange(left_out_, 0));
    return std::exchange(waiting_, std::nullopt);
  }

  std::mutex mutex_;
  std::optional<std::string> waiting_;
  std::chrono::seconds interval_;
  std::chrono::seconds ahead_;  ///< of the lines that a burst may have at once
  std::optional<Time> next_;    ///< when one line an interval would have the next one
  std::uint64_t left_out_ = 0;
};

}  // namespace coupler
