// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "host/core/clock.hpp"
#include "host/core/write.hpp"

namespace coupler::driver {

/// The writes that wait for the connection's owner, in order. Its lock is never held across a request, so
/// that a caller who pushes waits for nobody.
class WriteQueue {
 public:
  static constexpr std::size_t capacity = 1024;

  /// False if the queue is full: the device takes fewer writes than are made. The write is then not queued.
  bool push(const Write& write);
  std::optional<Write> take();

  /// Returns when there is a write to take, at `time`, or after stop().
  void wait_until(Time time);
  /// Ends the wait in progress and every later one at once.
  void stop();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Write> writes_;
  bool stopped_ = false;
};

}  // namespace coupler::driver
