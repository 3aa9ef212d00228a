// SPDX-License-Identifier: Apache-2.0
// The edges of one line: counted as the kernel reports them, or debounced.
#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// Counts the edges that the kernel reports of one line, and those that it cannot have reported.
class EdgeTally {
 public:
  /// `watched`: which edges are reported. `level`: the line's when reporting began.
  EdgeTally(Edge watched, bool level) : watched_(watched), latest_(level) {}

  /// Two equal edges in a row on a line watched for both: there was one between them.
  void edge(bool rising) {
    if (watched_ == Edge::both && latest_is_known_ && rising == latest_) ++edges_.lost;
    latest_ = rising;
    latest_is_known_ = true;
    ++(rising ? edges_.rising : edges_.falling);
  }

  /// The kernel dropped at least so many.
  void lose(std::uint32_t count) {
    edges_.lost += count;
    latest_is_known_ = false;
  }

  /// What was counted since the last call.
  Edges take() { return std::exchange(edges_, {}); }

 private:
  Edge watched_;
  bool latest_;
  bool latest_is_known_ = true;
  Edges edges_;
};

/// An input's level without its bouncing: a new level counts once the line has kept it for the period. It
/// gets edges and their times, may be asked at any time, and needs no timer.
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
