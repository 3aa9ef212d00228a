// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <rosgraph_msgs/msg/clock.hpp>

#include <atomic>
#include <chrono>
#include <memory>

#include "coupler/host/ros2/rcl/topics.hpp"

namespace coupler::host {

/// The time for stamps of messages: the system's, or that of /clock. Any thread may call.
class MessageClock {
 public:
  explicit MessageClock(rcl::Node& node) : node_(node) {}

  void use_simulated(bool simulated) {
    if (simulated && !subscription_)
      subscription_ = rcl::subscribe<rosgraph_msgs::msg::Clock>(
          node_, "/clock", rcl::best_effort(1), [this](const rosgraph_msgs::msg::Clock& message) {
            simulated_ =
                std::chrono::seconds(message.clock.sec) + std::chrono::nanoseconds(message.clock.nanosec);
          });
    is_simulated_ = simulated;
  }

  /// 0 until the first message of /clock.
  builtin_interfaces::msg::Time now() const {
    const std::chrono::nanoseconds since =
        is_simulated_ ? simulated_.load() : std::chrono::system_clock::now().time_since_epoch();
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since);
    builtin_interfaces::msg::Time time;
    time.sec = static_cast<std::int32_t>(seconds.count());
    time.nanosec = static_cast<std::uint32_t>((since - seconds).count());
    return time;
  }

 private:
  rcl::Node& node_;
  std::atomic<bool> is_simulated_{false};
  std::atomic<std::chrono::nanoseconds> simulated_{};
  std::shared_ptr<void> subscription_;
};

}  // namespace coupler::host
