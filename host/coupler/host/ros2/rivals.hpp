// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupler/host/ros/recurring.hpp"
#include "coupler/host/ros/rival_warnings.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::host {

/// Looks for other drivers of the same topics, in a thread of its own: a middleware may take its time to say.
class Rivals {
 public:
  Rivals(rcl::Node& node, Log& log) : node_(node), log_(log) {}

  /// Before begin(): a topic of this node, with its namespace.
  void watch(const std::string& topic) { topics_.push_back(topic); }
  void begin();
  void end() { recurring_.reset(); }

 private:
  void look();

  rcl::Node& node_;
  Log& log_;
  std::vector<std::string> topics_;
  RivalWarnings warnings_;
  std::optional<Recurring> recurring_;  // last: it uses the others
};

}  // namespace coupler::host
