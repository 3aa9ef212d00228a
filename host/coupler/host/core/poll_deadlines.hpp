// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The period of a rate in Hz, above 0.
inline Duration period_of(double rate) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1.0 / rate));
}

/// Deadlines that are `period` apart, counted from the start and not from the last cycle, so that they do not
/// drift. Deadlines that pass while a cycle runs are left out and counted.
class PollDeadlines {
 public:
  explicit PollDeadlines(Duration period) : period_(period) {}

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

}  // namespace coupler::host
