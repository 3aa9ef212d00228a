// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <XmlRpcValue.h>

#include "coupler/host/ros/rival_warnings.hpp"

namespace coupler::host {

/// What the ROS master knows of this node: topics, services and the node's parameters. roscpp registers them
/// once; a master that starts again knows nothing of them.
class Registrations {
 public:
  enum class Known { yes, no, by_another, no_master };

  /// Once ROS has started.
  Registrations();

  /// Asks the master whether it knows this node. `by_another`: another node has its name now.
  Known ask() const;
  /// Takes over what the master knows. What it does not say is kept as it was.
  void learn();
  /// At the last learn().
  const std::vector<Rival>& rivals() const { return rivals_; }
  /// Tells it to a master that does not know it. False if it did not take all. Not while ROS shuts down, when
  /// the master has been told that this node goes.
  bool tell() const;

 private:
  using Topics = std::map<std::string, std::string>;  ///< with their types

  // Kept: roscpp does not give them any more once it shuts down.
  std::string own_uri_;
  std::string service_uri_;
  std::vector<std::string> published_;
  std::vector<std::string> subscribed_;
  std::vector<std::string> services_;
  Topics types_;
  std::vector<Rival> rivals_;
  XmlRpc::XmlRpcValue parameters_;  ///< of the node's namespace
};

}  // namespace coupler::host
