// SPDX-License-Identifier: Apache-2.0
// What poll() waits for: a deadline, an event, another thread's call.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>

#include "coupler/base/descriptor.hpp"
#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The time since boot, including the time for which the machine was suspended.
inline std::chrono::nanoseconds time_since_boot() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// A point in time by which something must be done.
class Deadline {
 public:
  using Clock = std::chrono::nanoseconds (*)();
  explicit Deadline(std::chrono::milliseconds after, Clock now = time_since_boot)
      : now_(now), at_(now() + after) {}
  friend bool operator<(const Deadline& a, const Deadline& b) { return a.at_ < b.at_; }
  /// Returns the timeout for poll(): the milliseconds left, rounded up, and 0 when it has passed.
  int left() const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(at_ - now_());
    return static_cast<int>(std::max<std::chrono::milliseconds::rep>(left.count(), 0));
  }
  /// Time in which the process was stopped or the machine suspended counts: a reply found afterwards may be
  /// old, even if it came at once.
  bool has_passed() const { return now_() > at_; }

 private:
  Clock now_;
  std::chrono::nanoseconds at_;
};

/// Something that happens once. Any thread may set it. To make one throws std::system_error if no file
/// descriptor is left; so it does to make a Wakeup.
class Event {
 public:
  Event();
  void set();
  /// Whoever sees it set also sees what was done before.
  bool is_set() const { return set_.load(std::memory_order_acquire); }
  /// Readable from set() on.
  int fd() const { return fd_.get(); }

 private:
  Descriptor fd_;
  std::atomic<bool> set_{false};
};

/// Lets any thread end the poll() of another, now or the next time.
class Wakeup {
 public:
  Wakeup();
  void call();
  /// Forgets the calls so far.
  void clear();
  /// Readable from call() to clear().
  int fd() const { return fd_.get(); }

 private:
  Descriptor fd_;
};

/// How a wait ended.
enum class Woken { by_time, by_call, by_bytes };

/// Waits with poll() for a call, for an event if it is not null, for bytes from `socket` if it is not -1, or
/// for `time`.
Woken wait_for(Wakeup& wakeup, const Event* interrupted, int socket, Time time);

}  // namespace coupler::host
