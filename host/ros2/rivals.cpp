// SPDX-License-Identifier: Apache-2.0
#include "host/ros2/rivals.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace coupler::driver {
namespace {

constexpr auto interval = std::chrono::seconds(2);

}  // namespace

void Rivals::begin() {
  thread_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!ends_.wait_for(lock, interval, [this] { return ended_; })) {
      lock.unlock();
      look();
      lock.lock();
    }
  });
}

void Rivals::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ends_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Rivals::look() {
  std::set<std::string> now;
  const std::string own = node_.full_name();
  for (const std::string& topic : topics_) {
    bool is_first_own = true;
    for (const std::string& node : node_.publishers_of(topic)) {
      if (node == own && std::exchange(is_first_own, false)) continue;
      now.insert(topic + node);
      if (warned_of_.count(topic + node) == 0)
        warn_(fmt::format(
            "{} publishes {}, too: two drivers of one device, whose writes mix, or two devices of one "
            "name. End one of them, or give its device another name by --name",
            node == own ? "another node " + node : node, topic));
    }
  }
  warned_of_ = std::move(now);
}

}  // namespace coupler::driver
