// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace coupler::host {

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;

/// The source of time for the core. Tests have one of their own.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
  /// Returns at `time`, or earlier if the program is about to end.
  virtual void sleep_until(Time time) = 0;
};

/// The machine's monotonic clock.
class SteadyClock : public Clock {
 public:
  Time now() const override { return std::chrono::steady_clock::now(); }
  void sleep_until(Time time) override;
  /// From any thread: ends the sleep in progress and every later one at once.
  void stop();

 private:
  std::mutex mutex_;
  std::condition_variable stopped_now_;
  bool stopped_ = false;
};

}  // namespace coupler::host
