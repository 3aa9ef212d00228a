// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// Waits for the next value of a point. The connection's thread delivers what it has read.
class ValueWaiter {
 public:
  /// The registers of the first value of `point` that the device is asked for from now on (bit tables: each
  /// bit as one register, 0 or 1). nullopt after `deadline` or cancel(), and while the device is offline:
  /// there is nothing to wait for. For one thread.
  /// `ask` is called when the wait has begun; it must not wait for anything.
  std::optional<std::vector<std::uint16_t>> wait(
      std::uint32_t point, Time deadline, const std::function<void()>& ask = [] {}) {
    std::unique_lock lock(mutex_);
    value_.reset();
    since_ = std::chrono::steady_clock::now();
    point_ = point;
    ask();
    changed_.wait_until(lock, deadline, [this] { return value_.has_value() || !online_ || cancelled_; });
    point_ = none;
    return std::move(value_);
  }

  /// Costs nothing.
  bool waits_for(std::uint32_t point) const { return point_.load(std::memory_order_relaxed) == point; }
  /// A value that the device was asked for before the wait began is not the next one.
  void deliver(const std::uint16_t* registers, std::size_t count, Time asked) {
    {
      const std::lock_guard lock(mutex_);
      if (asked < since_) return;
      value_.emplace(registers, registers + count);
      point_ = none;
    }
    changed_.notify_one();
  }

  /// See Sink::on_online(). At first the device is offline.
  void set_online(bool online) {
    {
      const std::lock_guard lock(mutex_);
      online_ = online;
    }
    changed_.notify_one();
  }

  /// Ends the wait in progress and every later one at once.
  void cancel() {
    {
      const std::lock_guard lock(mutex_);
      cancelled_ = true;
    }
    changed_.notify_one();
  }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::atomic<std::uint32_t> point_{none};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::vector<std::uint16_t>> value_;
  Time since_{};  ///< begin of the wait
  bool online_ = false;
  bool cancelled_ = false;
};

}  // namespace coupler::host
