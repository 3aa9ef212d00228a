// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/ros/graph_watch.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/topic_check.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::host {

/// Looks at the graph, and warns of a second driver and of what others do at the topics of this one. In a
/// thread of its own, since the middleware may take its time.
class GraphWatch {
 public:
  /// All topics must have been made. `online_topics`: with their namespaces.
  GraphWatch(Node& log, rcl::Node& node, const TopicCheck& topics, std::vector<std::string> online_topics);

 private:
  void look();
  void warn(const std::vector<std::string>& lines);
  void warn_of_duplicates();
  void warn_of_wrong_topics();

  Node& log_;
  rcl::Node& node_;
  const TopicCheck& topics_;
  std::vector<std::string> online_topics_;
  OnceWarnings duplicates_;
  OnceWarnings wrong_topics_;
  bool has_looked_ = false;
  PeriodicThread thread_;  // last: it uses the others
};

}  // namespace coupler::host
