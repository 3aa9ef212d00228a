// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace coupler::host {

/// Calls a function at once and then every so often, in a thread of its own.
class Recurring {
 public:
  Recurring(std::chrono::milliseconds interval, std::function<void()> function)
      : thread_([this, interval, function = std::move(function)] {
          do function();
          while (!ends_within(interval));
        }) {}
  /// Waits for the call in progress.
  ~Recurring() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    ends_.notify_one();
    thread_.join();
  }
  Recurring(const Recurring&) = delete;
  Recurring& operator=(const Recurring&) = delete;

 private:
  bool ends_within(std::chrono::milliseconds interval) {
    std::unique_lock lock(mutex_);
    return ends_.wait_for(lock, interval, [this] { return ended_; });
  }

  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
