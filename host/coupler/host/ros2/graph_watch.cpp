// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/graph_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
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
    for (const auto& [node, type] : node_.ends_of(topic, rcl::Node::Ends::publishers)) {
      if (node.empty()) continue;
      if (node != node_.full_name())
        duplicates.push_back({topic, node});
      else if (!std::exchange(is_first_own, false))
        duplicates.push_back({topic, "another node " + node});
    }
  }
  warn(duplicates_.update(findings_of(duplicates), "drivers"));
}

void GraphWatch::add_others(const std::string& topic, rcl::Node::Ends which,
                            std::vector<Endpoint>& others) const {
  for (auto& [node, type] : node_.ends_of(topic, which))
    if (!node.empty() && node != node_.full_name())
      others.push_back({topic, std::move(node), which == rcl::Node::Ends::publishers, std::move(type)});
}

/// The ends of a topic cost a look at all ends of the graph: only those of topics with something odd are
/// asked for, and of as many as that takes little time for.
void GraphWatch::warn_of_wrong_topics() {
  constexpr std::size_t most = 1000;
  std::vector<std::string> odd;
  std::vector<std::string> foreign;
  for (auto& [topic, types] : node_.topics()) {
    const bool is_own =
        !topics_.needed_type(topic, false).empty() || !topics_.needed_type(topic, true).empty();
    if (is_own && types.size() > 1)
      odd.push_back(std::move(topic));
    else if (!is_own && topics_.may_be_mistaken(topic))
      foreign.push_back(std::move(topic));
  }
  odd.insert(odd.end(), foreign.begin(), foreign.end());
  odd.resize(std::min(odd.size(), most));
  std::vector<Endpoint> others;
  for (const std::string& topic : odd) {
    add_others(topic, rcl::Node::Ends::publishers, others);
    add_others(topic, rcl::Node::Ends::subscriptions, others);
  }
  warn(wrong_topics_.update(topics_.check(others), "publishers and subscribers with a wrong type or name"));
}

}  // namespace coupler::host
