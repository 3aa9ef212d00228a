// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <utility>

#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// An input's level without its bouncing: a new level counts once the line has kept it for the period. Fed
/// with edges and their times, asked at any time; it needs no timer.
class Debounce {
 public:
  Debounce(std::chrono::microseconds period, bool level) : period_(period), settled_(level), latest_(level) {}

  /// The line changed to `level`. Two edges to the same level mean that one between them was missed: the line
  /// was not quiet, so the period begins anew.
  void edge(bool level, TimePoint at) {
    settle(at);
    latest_ = level;
    since_ = at;
  }

  /// The level that counts.
  bool level(TimePoint now) {
    settle(now);
    return settled_;
  }

  /// The changes of that level since the last call.
  Edges take_edges(TimePoint now) {
    settle(now);
    return std::exchange(edges_, {});
  }

  /// The level that the last edge brought.
  bool latest() const { return latest_; }

 private:
  void settle(TimePoint now) {
    if (now - since_ < period_ || settled_ == latest_) return;
    settled_ = latest_;
    ++(settled_ ? edges_.rising : edges_.falling);
  }

  std::chrono::microseconds period_;
  bool settled_;
  bool latest_;
  TimePoint since_{};
  Edges edges_;
};

}  // namespace coupler::device
