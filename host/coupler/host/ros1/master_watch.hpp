// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <XmlRpcValue.h>

#include "coupler/host/ros/graph_watch.hpp"

namespace coupler::host {

/// Watches what the ROS master knows of this node: topics, services and the node's parameters. roscpp
/// registers them once, and a master that starts again knows nothing of them.
class Registrations {
 public:
  enum class Known { yes, no, by_another, no_master };

  /// Once ROS has started.
  Registrations();

  /// Asks the master whether it knows this node. `by_another`: another node has its name now.
  Known check() const;
  /// Remembers what the master knows. What it does not answer is kept as it was.
  void update();
  /// At the last update().
  const std::vector<DuplicateDriver>& duplicates() const { return duplicates_; }
  /// Registers this node with a master that does not know it. False if the master did not take all. Not while
  /// ROS shuts down: this node has been unregistered then.
  bool restore() const;

 private:
  // Kept: roscpp does not give them any more once it shuts down.
  std::string own_uri_;
  std::string service_uri_;
  std::vector<std::string> published_;
  std::vector<std::string> subscribed_;
  std::vector<std::string> services_;
  std::map<std::string, std::string> types_;  ///< of topics
  std::vector<DuplicateDriver> duplicates_;
  XmlRpc::XmlRpcValue parameters_;  ///< of the node's namespace
};

/// Registers this node again with a ROS master that has started again: with roscpp alone it would stay
/// invisible. The devices go on meanwhile. In a thread of its own, since a master may take its time.
class MasterWatch {
 public:
  /// All topics and services must have been advertised.
  explicit MasterWatch(Node& log);

 private:
  void try_check();
  void check();
  void update();

  Node& log_;
  Registrations registrations_;
  unsigned updates_ = 0;
  bool told_ = false;  ///< that an answer cannot be read
  DuplicateWarnings duplicates_;
  Registrations::Known known_ = Registrations::Known::yes;
  PeriodicThread thread_;  // last: it uses the others
};

}  // namespace coupler::host
