// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// One who waits for the next value of a point: the connection's thread brings what it has read.
class ValueWaiter {
 public:
  /// The registers of the first value of `point` that is asked for from now on (bit tables: each bit as one
  /// register, 0 or 1), or nullopt if none has come until `deadline` or end(), or while the device is
  /// offline: there is nothing to wait for. For one thread.
  std::optional<std::vector<std::uint16_t>> wait(std::uint32_t point, Time deadline) {
    std::unique_lock lock(mutex_);
    value_.reset();
    since_ = std::chrono::steady_clock::now();
    wanted_ = point;
    came_.wait_until(lock, deadline, [this] { return value_.has_value() || !online_ || ended_; });
    wanted_ = nobody;
    return std::move(value_);
  }

  /// Whether there is somebody; costs nothing.
  bool is_wanted(std::uint32_t point) const { return wanted_.load(std::memory_order_relaxed) == point; }
  /// What the device was asked for before somebody waited may be older than the wait.
  void bring(const std::uint16_t* registers, std::size_t count, Time asked) {
    {
      const std::lock_guard lock(mutex_);
      if (asked < since_) return;
      value_.emplace(registers, registers + count);
      wanted_ = nobody;
    }
    came_.notify_one();
  }

  /// As Sink::on_online(): at first it is not.
  void online(bool online) {
    {
      const std::lock_guard lock(mutex_);
      online_ = online;
    }
    came_.notify_one();
  }

  /// Ends the wait in progress and every later one at once.
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    came_.notify_one();
  }

 private:
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

  std::atomic<std::uint32_t> wanted_{nobody};
  std::mutex mutex_;
  std::condition_variable came_;
  std::optional<std::vector<std::uint16_t>> value_;
  Time since_{};  ///< the wait
  bool online_ = false;
  bool ended_ = false;
};

}  // namespace coupler::host
