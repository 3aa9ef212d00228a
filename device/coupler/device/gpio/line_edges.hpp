// SPDX-License-Identifier: Apache-2.0
// The edges of one line: counted as the kernel reports them, or debounced.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// Counts the edges of a line that is watched for both, and those that cannot have been reported.
class EdgeTally {
 public:
  /// `counted`: which edges somebody counts; losses of the others are not counted. `level`: the line's when
  /// reporting began.
  EdgeTally(Edge counted, bool level) : counted_(counted), latest_(level) {}

  /// Two equal edges in a row: there was one between them. Returns whether that is so.
  bool edge(bool rising) {
    const bool hides_one = latest_is_known_ && rising == latest_;
    if (hides_one && counted_ != (rising ? Edge::rising : Edge::falling)) ++edges_.lost;
    latest_ = rising;
    latest_is_known_ = true;
    ++(rising ? edges_.rising : edges_.falling);
    return hides_one;
  }

  /// The kernel dropped at least so many. They rise and fall in turn.
  void lose(std::uint32_t count) {
    edges_.lost += counted_ == Edge::both ? count : count / 2 + count % 2;
    latest_is_known_ = false;
  }

  /// Takes the edges that were counted since the last call.
  Edges take() { return std::exchange(edges_, {}); }

 private:
  Edge counted_;
  bool latest_;
  bool latest_is_known_ = true;
  Edges edges_;
};

/// A level of an input since a moment.
struct LevelSince {
  bool level = false;
  TimePoint at{};
};

/// An input's level without its bouncing: a new level counts once the line has kept it for the period, and
/// from the edge on that brought it. It gets edges and their times, may be asked at any time, and needs no
/// timer.
class Debounce {
 public:
  Debounce(std::chrono::microseconds period, bool level) : period_(period), settled_(level), latest_(level) {}

  /// The line changed to `level`. Two edges to the same level mean that one between them was missed: the line
  /// was not quiet, so the period begins anew. Returns what settle() would have.
  std::optional<LevelSince> edge(bool level, TimePoint at) {
    const auto settled = settle(at);
    latest_ = level;
    since_ = at;
    return settled;
  }

  /// The new level if there is one. Each is told once.
  std::optional<LevelSince> settle(TimePoint now) {
    if (now - since_ < period_ || settled_ == latest_) return std::nullopt;
    settled_ = latest_;
    return LevelSince{settled_, since_};
  }

  /// When settle() will have a new level if the line stays as it is.
  std::optional<TimePoint> due() const {
    return settled_ == latest_ ? std::nullopt : std::optional(since_ + period_);
  }

  /// The level that counts.
  bool level() const { return settled_; }
  /// The level that the last edge brought.
  bool latest() const { return latest_; }

 private:
  std::chrono::microseconds period_;
  bool settled_;
  bool latest_;
  TimePoint since_{};
};

}  // namespace coupler::device
