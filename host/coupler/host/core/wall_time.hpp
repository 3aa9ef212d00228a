// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The machine's wall clock beside its monotonic one. Both run at one rate, so that one difference lasts
/// until somebody sets the wall clock: stamps do not tremble, and those of one request are equal.
class WallTime {
 public:
  using Wall = std::chrono::nanoseconds;  ///< since 1970

  /// The wall clock said `wall` between `before` and `after`. Returns how far somebody has set it since the
  /// last measurement, 0 if nobody has: what a daemon corrects bit by bit is not told.
  Duration measure(Time before, Wall wall, Time after) {
    const Duration half = (after - before) / 2;
    const Wall difference = wall - (before + half).time_since_epoch();
    const Duration error = after - before - half;
    // A measurement that was interrupted says nothing against a better one.
    const Duration moved = measured_ ? difference - difference_ : Duration::zero();
    const Duration corrected = std::min(
        least_step + (after - std::exchange(measured_at_, after)) / fastest_correction, most_corrected);
    const bool differs = !measured_ || std::chrono::abs(moved) > error + error_;
    if (!differs && error >= error_) return Duration::zero();
    measured_ = true;
    difference_ = difference;
    error_ = error;
    return std::chrono::abs(moved) > corrected + error ? moved : Duration::zero();
  }
  /// Now.
  Duration measure() {
    const Time before = std::chrono::steady_clock::now();
    const Wall wall = std::chrono::system_clock::now().time_since_epoch();
    return measure(before, wall, std::chrono::steady_clock::now());
  }

  Wall of(Time time) const { return time.time_since_epoch() + difference_; }
  /// When the wall clock says `wall`, unless somebody sets it.
  Time at(Wall wall) const { return Time(std::chrono::duration_cast<Duration>(wall - difference_)); }
  /// They may say the same: nobody has set the wall clock between their measurements.
  bool agrees_with(const WallTime& other) const {
    return measured_ && other.measured_ &&
           std::chrono::abs(difference_ - other.difference_) <= error_ + other.error_;
  }
  /// How far of() and at() may be wrong.
  Duration error() const { return error_; }

 private:
  static constexpr Duration least_step = std::chrono::milliseconds(50);
  /// A daemon corrects the clock by a twelfth of the time at most (chrony, `maxslewrate`); what is more than
  /// a second it sets, or it is told as if.
  static constexpr int fastest_correction = 12;
  static constexpr Duration most_corrected = std::chrono::seconds(1);

  bool measured_ = false;
  Time measured_at_{};
  Wall difference_{};
  Duration error_{};
};

}  // namespace coupler::host
