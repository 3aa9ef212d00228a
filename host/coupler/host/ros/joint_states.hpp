// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/motion/joints.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// The topic `<name>/joint_states`: where the joints of a device are. A joint whose position is not known is
/// left out. A point with the same name takes precedence.
class JointStates {
 public:
  /// The joints must outlive it.
  JointStates(Node& node, const Map& map, const Joints& joints);

  /// From one thread only. The stamp is the latest time at which all of the joints were known to be there.
  /// Publishes nothing unless the stamp is later than the last one: MoveIt treats even an equal stamp as a
  /// jump of the clock.
  void publish(Time now);

 private:
  const Joints& joints_;
  Node::PublishJoints publish_;     ///< empty: a point has the name
  std::vector<Node::Joint> known_;  ///< a buffer
  Time last_{};                     ///< of the last message
  WallTime wall_;                   ///< one for all messages, so that their stamps do not jitter
};

}  // namespace coupler::host
