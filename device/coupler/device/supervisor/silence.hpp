// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// How long another process has been silent, and whether that is too long. It is told at each glance; clock
/// and numbers are handed in.
class Silence {
 public:
  /// Without the time that the other one has waited for the CPU: starvation is no hang.
  static constexpr std::chrono::seconds limit{1};
  /// With that time: nobody drives outputs meanwhile.
  static constexpr std::chrono::seconds limit_in_any_case{5};

  /// A glance counts for no more than `longest_glance`: this process may have been stopped or starved itself,
  /// and what the other one said meanwhile still waits to be heard. `waited` as in sample().
  Silence(TimePoint now, std::chrono::nanoseconds longest_glance, std::chrono::nanoseconds waited)
      : longest_glance_(longest_glance), last_(now), last_waited_(waited) {}

  /// The end of a glance. `heard`: the other one said something. `waited`: the time that it has waited for
  /// the CPU in its life.
  void sample(TimePoint now, bool heard, std::chrono::nanoseconds waited) {
    using std::chrono::nanoseconds;
    const nanoseconds elapsed = now - last_;
    const nanoseconds counted = std::min(elapsed, longest_glance_);
    nanoseconds starved = waited - last_waited_;
    // What does not count is not deducted either.
    if (elapsed > counted) starved = std::min(starved, counted);
    last_ = now;
    last_waited_ = waited;
    lasted_ = heard ? nanoseconds(0) : lasted_ + counted;
    starved_ = heard ? nanoseconds(0) : std::clamp(starved_ + starved, nanoseconds(0), lasted_);
  }

  bool is_too_long() const { return lasted_ - starved_ >= limit || lasted_ >= limit_in_any_case; }

  std::chrono::nanoseconds lasted() const { return lasted_; }
  /// How much of it the other one waited for the CPU.
  std::chrono::nanoseconds starved() const { return starved_; }

 private:
  std::chrono::nanoseconds longest_glance_;
  TimePoint last_;
  std::chrono::nanoseconds last_waited_;
  std::chrono::nanoseconds lasted_{0};
  std::chrono::nanoseconds starved_{0};
};

}  // namespace coupler::device
