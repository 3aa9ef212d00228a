// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The difference between the machine's wall clock and its monotonic clock. Both run at one rate, so the
/// difference stays the same until somebody sets the wall clock. So stamps do not jitter, and those of one
/// request are equal.
class WallTime {
 public:
  using Wall = std::chrono::nanoseconds;  ///< since 1970

  /// The wall clock said `wall` between `before` and `after`. Returns how far somebody has set it since the
  /// last measurement, or it has gone on while the machine slept; 0 for less than 50 ms.
  Duration measure(Time before, Wall wall, Time after) {
    const Duration half = (after - before) / 2;
    const Wall difference = wall - (before + half).time_since_epoch();
    const Duration error = after - before - half;
    const Duration moved = measured_ ? difference - difference_ : Duration::zero();
    const Duration unexplained = std::chrono::abs(moved) - error - error_;
    const bool was_set = unexplained > Duration::zero();
    // A measurement that was interrupted says nothing against a better one.
    if (measured_ && !was_set && error >= error_) return Duration::zero();
    measured_ = true;
    difference_ = difference;
    error_ = error;
    if (was_set) ++times_set_;
    return unexplained > least_told ? moved : Duration::zero();
  }
  /// Measures the difference now.
  Duration measure() {
    const Time before = std::chrono::steady_clock::now();
    const Wall wall = std::chrono::system_clock::now().time_since_epoch();
    return measure(before, wall, std::chrono::steady_clock::now());
  }

  Wall of(Time time) const { return time.time_since_epoch() + difference_; }
  /// Returns the time at which the wall clock will show `wall`, unless somebody sets it.
  Time at(Wall wall) const { return Time(std::chrono::duration_cast<Duration>(wall - difference_)); }
  /// Returns whether nobody has set the wall clock between the two measurements, as far as can be told.
  bool agrees_with(const WallTime& other) const {
    return measured_ && other.measured_ &&
           std::chrono::abs(difference_ - other.difference_) <= error_ + other.error_;
  }
  /// The number of times that somebody has set it, as far as was measured.
  std::uint32_t times_set() const { return times_set_; }
  /// The possible error of of() and at().
  Duration error() const { return error_; }

 private:
  static constexpr Duration least_told = std::chrono::milliseconds(50);

  bool measured_ = false;
  Wall difference_{};
  Duration error_{};
  std::uint32_t times_set_ = 0;
};

/// The difference as it is now, by the best of several measurements, since one may be interrupted.
inline WallTime measured_wall_time() {
  WallTime wall;
  for (int i = 0; i < 5; ++i) wall.measure();
  return wall;
}

}  // namespace coupler::host
