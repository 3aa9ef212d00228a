// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

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
