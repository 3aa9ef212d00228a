// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace coupler {

/// Limits log lines of one kind to one a second. The first is logged at once; of those that follow within the
/// second only the newest when it is over, with the number of those left out. Any thread may call.
class LineLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr auto interval = std::chrono::seconds(1);

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
    return waiting_ ? std::optional(said_.value_or(Time()) + interval) : std::nullopt;
  }

 private:
  std::optional<std::string> take(Time now) {
    if (!waiting_ || (said_ && now - *said_ < interval)) return std::nullopt;
    said_ = now;
    if (left_out_ > 0) *waiting_ += fmt::format(" (and {} more of this kind)", std::exchange(left_out_, 0));
    return std::exchange(waiting_, std::nullopt);
  }

  std::mutex mutex_;
  std::optional<std::string> waiting_;
  std::optional<Time> said_;
  std::uint64_t left_out_ = 0;
};

}  // namespace coupler
