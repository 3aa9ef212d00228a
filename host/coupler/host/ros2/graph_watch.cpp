// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/graph_watch.hpp"

#include <chrono>
#include <utility>

namespace coupler::host {
namespace {

constexpr auto interval = std::chrono::seconds(2);

}  // namespace

GraphWatch::GraphWatch(Node& log, rcl::Node& node, const TopicCheck& topics,
                       std::vector<std::string> online_topics)
    : log_(log),
      node_(node),
      topics_(topics),
      online_topics_(std::move(online_topics)),
      thread_(interval, [this] { look(); }) {}

void GraphWatch::look() {
  if (!node_.graph_has_changed() && has_looked_) return;
  has_looked_ = true;
  warn_of_duplicates();
  warn_of_wrong_topics();
}

void GraphWatch::warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) log_.log(Level::warning, line);
}

void GraphWatch::warn_of_duplicates() {
  std::vector<DuplicateDriver> duplicates;
  for (const std::string& topic : online_topics_) {
    bool is_first_own = true;
    for (const std::string& node : node_.publishers_of(topic)) {
      if (node.empty()) continue;
      if (node != node_.full_name())
        duplicates.push_back({topic, node});
      else if (!std::exchange(is_first_own, false))
        duplicates.push_back({topic, "another node " + node});
    }
  }
  warn(duplicates_.update(findings_of(duplicates), "drivers"));
}

void GraphWatch::warn_of_wrong_topics() {
  std::vector<Endpoint> others;
  for (auto& [topic, node, publishes, type] : node_.ends_of_others())
    if (topics_.concerns(topic))
      others.push_back({std::move(topic), std::move(node), publishes, std::move(type)});
  warn(wrong_topics_.update(topics_.check(others),
                            "publishers and subscribers at a wrong place or with a wrong type"));
}

}  // namespace coupler::host
