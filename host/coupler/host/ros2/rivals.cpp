// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rivals.hpp"

#include <chrono>
#include <utility>

namespace coupler::host {
namespace {

constexpr auto interval = std::chrono::seconds(2);

}  // namespace

void Rivals::begin() {
  recurring_.emplace(interval, [this] { look(); });
}

void Rivals::look() {
  std::vector<Rival> rivals;
  for (const std::string& topic : topics_) {
    bool is_first_own = true;
    for (const std::string& node : node_.publishers_of(topic)) {
      if (node.find("_UNKNOWN_") != std::string::npos) continue;  // the graph does not know its name yet
      if (node != node_.full_name())
        rivals.push_back({topic, node});
      else if (!std::exchange(is_first_own, false))
        rivals.push_back({topic, "another node " + node});
    }
  }
  warnings_.warn_of(rivals, log_);
}

}  // namespace coupler::host
