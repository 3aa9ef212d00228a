// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <XmlRpcValue.h>

#include "coupler/host/ros/graph_watch.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/topic_check.hpp"
#include "coupler/host/ros1/topic_types.hpp"

namespace coupler::host {

/// Watches what the ROS master knows of this node: topics, services and the node's parameters. roscpp
/// registers them once, and a master that starts again knows nothing of them.
class Registrations {
 public:
  enum class Known { yes, no, by_another, no_master };

  /// Once ROS has started.
  explicit Registrations(const TopicCheck& topics);

  /// Asks the master whether it knows this node. `by_another`: another node has its name now.
  Known check() const;
  /// Remembers what the master knows. What it does not answer is kept as it was.
  void update();
  /// At the last update().
  const std::vector<DuplicateDriver>& duplicates() const { return duplicates_; }
  /// At the last update(): the ends that other nodes have of topics that concern `topics`, without types.
  const std::vector<Endpoint>& others() const { return others_; }
  /// Registers this node with a master that does not know it. False if the master did not take all. Not while
  /// ROS shuts down: this node has been unregistered then.
  bool restore() const;

 private:
  const TopicCheck& topics_;
  // Kept: roscpp does not give them any more once it shuts down.
  std::string own_uri_;
  std::string service_uri_;
  std::vector<std::string> published_;
  std::vector<std::string> subscribed_;
  std::vector<std::string> services_;
  std::map<std::string, std::string> types_;  ///< of topics
  std::vector<DuplicateDriver> duplicates_;
  std::vector<Endpoint> others_;
  XmlRpc::XmlRpcValue parameters_;  ///< of the node's namespace
};

/// Registers this node again with a ROS master that has started again: with roscpp alone it would stay
/// invisible. The devices go on meanwhile. Warns of what others do at its topics. In a thread of its own,
/// since a master may take its time.
class MasterWatch {
 public:
  /// All topics and services must have been advertised.
  MasterWatch(Node& log, const TopicCheck& topics);

 private:
  void try_check();
  void check();
  void update();
  void warn(const std::vector<std::string>& lines);

  Node& log_;
  const TopicCheck& topics_;
  TopicTypes types_;
  Registrations registrations_;
  unsigned updates_ = 0;
  bool told_ = false;  ///< that an answer cannot be read
  OnceWarnings duplicates_;
  OnceWarnings wrong_topics_;
  Registrations::Known known_ = Registrations::Known::yes;
  PeriodicThread thread_;  // last: it uses the others
};

}  // namespace coupler::host
