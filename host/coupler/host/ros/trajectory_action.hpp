// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "coupler/host/motion/trajectories.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// The action `<name>/follow_joint_trajectory` of a device's joints. A point with the same name takes
/// precedence.
class TrajectoryAction {
 public:
  /// The storage of `map`, the joints and the trajectories must outlive it. Nothing is offered yet.
  TrajectoryAction(Node& node, const Map& map, const Joints& joints, Trajectories& trajectories)
      : node_(node), map_(map), joints_(joints), trajectories_(trajectories) {}

  void offer();
  /// Tells the client of the goal what its joints do. Any thread may call it.
  void feed_back(Time now);

 private:
  void begin(TrajectoryServer& server, GoalNumber number, Time received, const TrajectoryGoal& goal);

  Node& node_;
  const Map& map_;
  const Joints& joints_;
  Trajectories& trajectories_;
  std::atomic<TrajectoryServer*> serving_{nullptr};  ///< it has had a goal
  std::unique_ptr<TrajectoryServer> server_;         // last: its thread uses the others
};

}  // namespace coupler::host
