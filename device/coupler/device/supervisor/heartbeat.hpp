// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// How often a worker process reports that its loop, which answers clients, still turns.
constexpr std::chrono::milliseconds heartbeat_period{200};

/// How long another process has been silent, and whether that is too long. It is sampled in each turn of a
/// loop; clock and numbers are handed in.
class Silence {
 public:
  /// Without the time that the other process has waited for the CPU: one that starves does not hang.
  static constexpr std::chrono::seconds limit{1};
  /// With that time: meanwhile nobody drives outputs.
  static constexpr std::chrono::seconds limit_in_any_case{5};

  /// A turn counts for no more than `longest_turn`: this process may have been stopped or starved itself, and
  /// messages of the other one may wait to be read. `waited` as in sample().
  Silence(TimePoint now, std::chrono::nanoseconds longest_turn, std::chrono::nanoseconds waited)
      : longest_turn_(longest_turn), last_(now), last_waited_(waited) {}

  /// The end of a turn. `heard`: a message of the other process came. `waited`: the time that it has waited
  /// for the CPU in its life.
  void sample(TimePoint now, bool heard, std::chrono::nanoseconds waited) {
    using std::chrono::nanoseconds;
    const nanoseconds elapsed = now - last_;
    const nanoseconds counted = std::min(elapsed, longest_turn_);
    nanoseconds starved = waited - last_waited_;
    // Time that does not count is not deducted either.
    if (elapsed > counted) starved = std::min(starved, counted);
    last_ = now;
    last_waited_ = waited;
    lasted_ = heard ? nanoseconds(0) : lasted_ + counted;
    starved_ = heard ? nanoseconds(0) : std::clamp(starved_ + starved, nanoseconds(0), lasted_);
  }

  bool is_too_long() const { return lasted_ - starved_ >= limit || lasted_ >= limit_in_any_case; }

  std::chrono::nanoseconds lasted() const { return lasted_; }
  /// How much of it the other process waited for the CPU.
  std::chrono::nanoseconds starved() const { return starved_; }

 private:
  std::chrono::nanoseconds longest_turn_;
  TimePoint last_;
  std::chrono::nanoseconds last_waited_;
  std::chrono::nanoseconds lasted_{0};
  std::chrono::nanoseconds starved_{0};
};

}  // namespace coupler::device
