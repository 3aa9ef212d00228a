// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The machine's wall clock beside its monotonic one. Both run at one rate, so that one difference lasts
/// until somebody sets the wall clock: stamps do not tremble, and those of one request are equal.
class WallTime {
 public:
  using Wall = std::chrono::nanoseconds;  ///< since 1970

  /// The wall clock said `wall` between `before` and `after`.
  void measure(Time before, Wall wall, Time after) {
    const Duration half = (after - before) / 2;
    const Wall difference = wall - (before + half).time_since_epoch();
    const Duration error = after - before - half;
    // A measurement that was interrupted says nothing against a better one.
    const bool was_set = !measured_ || std::chrono::abs(difference - difference_) > error + error_;
    if (!was_set && error >= error_) return;
    measured_ = true;
    difference_ = difference;
    error_ = error;
  }
  /// Now.
  void measure() {
    const Time before = std::chrono::steady_clock::now();
    const Wall wall = std::chrono::system_clock::now().time_since_epoch();
    measure(before, wall, std::chrono::steady_clock::now());
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
  bool measured_ = false;
  Wall difference_{};
  Duration error_{};
};

}  // namespace coupler::host
