// SPDX-License-Identifier: Apache-2.0
// What looks at the ROS graph now and then, beside the driver: a thread for it, and duplicates of this
// driver.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/host/ros/once_warnings.hpp"

namespace coupler::host {

/// Calls a function at once and then at an interval, in a thread of its own.
class PeriodicThread {
 public:
  PeriodicThread(std::chrono::milliseconds interval, std::function<void()> function)
      : thread_([this, interval, function = std::move(function)] {
          do function();
          while (!stops_within(interval));
        }) {}
  /// Waits for the call in progress.
  ~PeriodicThread() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    stop_.notify_one();
    thread_.join();
  }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

 private:
  bool stops_within(std::chrono::milliseconds interval) {
    std::unique_lock lock(mutex_);
    return stop_.wait_for(lock, interval, [this] { return stopped_; });
  }

  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopped_ = false;
  std::thread thread_;  // last: it uses the others
};

/// Another node that publishes `<name>/online`, as this one does: two drivers of one device, or of one name.
struct DuplicateDriver {
  std::string topic;
  std::string node;
};

inline std::vector<Finding> findings_of(const std::vector<DuplicateDriver>& duplicates) {
  std::vector<Finding> findings;
  findings.reserve(duplicates.size());
  for (const auto& [topic, node] : duplicates)
    findings.push_back(
        {topic + node, [topic = topic, node = node] {
           return fmt::format(
               "{} also publishes {}: two drivers write to the same device, two devices have the same name, "
               "or a recording is played. Stop one of them, or give it other topics (a driver by --name)",
               node, topic);
         }});
  return findings;
}

}  // namespace coupler::host
