// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <rosgraph_msgs/msg/clock.hpp>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>

#include "coupler/host/ros2/rcl/topics.hpp"

namespace coupler::host {

/// The time for stamps of messages: the system's, or that of /clock. Any thread may call.
class MessageClock {
 public:
  explicit MessageClock(rcl::Node& node) : node_(node) {}

  void use_simulated(bool simulated) {
    if (simulated && !subscription_)
      subscription_ = std::make_unique<rcl::Subscription<rosgraph_msgs::msg::Clock>>(
          node_, "/clock", rcl::best_effort(1), [this](const rosgraph_msgs::msg::Clock& message) {
            const std::lock_guard lock(mutex_);
            simulated_ = message.clock;
          });
    is_simulated_ = simulated;
  }

  /// 0 until the first message of /clock.
  builtin_interfaces::msg::Time now() const {
    if (is_simulated_) {
      const std::lock_guard lock(mutex_);
      return simulated_;
    }
    const auto since = std::chrono::system_clock::now().time_since_epoch();
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since);
    builtin_interfaces::msg::Time time;
    time.sec = static_cast<std::int32_t>(seconds.count());
    time.nanosec = static_cast<std::uint32_t>(std::chrono::nanoseconds(since - seconds).count());
    return time;
  }

 private:
  rcl::Node& node_;
  std::atomic<bool> is_simulated_{false};
  mutable std::mutex mutex_;
  builtin_interfaces::msg::Time simulated_;
  std::unique_ptr<rcl::Subscription<rosgraph_msgs::msg::Clock>> subscription_;
};

}  // namespace coupler::host
