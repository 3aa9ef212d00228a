// SPDX-License-Identifier: Apache-2.0
// Times at which something is due again: at a rate, or after a failure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The period of a rate in Hz, above 0.
inline Duration period_of(double rate) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1.0 / rate));
}

/// Deadlines that are `period` apart, counted from the start and not from the last cycle, so that they do not
/// drift. Deadlines that pass while a cycle runs are left out and counted.
class Schedule {
 public:
  explicit Schedule(Duration period) : period_(period) {}

  /// The first deadline is `now`.
  void start(Time now) { due_ = now; }
  Time due() const { return due_; }
  Duration period() const { return period_; }

  /// Notes that the cycle of the current deadline has ended at `now`.
  void advance(Time now) {
    due_ += period_;
    if (now < due_) return;
    const auto missed = (now - due_) / period_ + 1;
    due_ += missed * period_;
    overruns_ += static_cast<std::uint64_t>(missed);
  }

  /// The number of deadlines that were left out since construction.
  std::uint64_t overruns() const { return overruns_; }

 private:
  Duration period_;
  Time due_{};
  std::uint64_t overruns_ = 0;
};

/// The time to wait before the next attempt: 0.1 s, doubling up to 5 s.
class Backoff {
 public:
  Duration next() {
    const Duration delay = next_;
    next_ = std::min<Duration>(2 * next_, longest);
    return delay;
  }
  void reset() { next_ = shortest; }

 private:
  static constexpr Duration shortest = std::chrono::milliseconds(100);
  static constexpr Duration longest = std::chrono::seconds(5);
  Duration next_ = shortest;
};

}  // namespace coupler::host
