// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace coupler::host {

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;

/// Where the core gets its time from, so that tests can make it.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
  /// Returns at `time`, or earlier if the program is about to end.
  virtual void sleep_until(Time time) = 0;
};

}  // namespace coupler::host
