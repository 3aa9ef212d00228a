// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/joint_states.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"

namespace coupler::host {

JointStates::JointStates(Node& node, const Map& map, const Joints& joints) : joints_(joints) {
  if (find(map, joint_states_topic) == nullptr)
    publish_ = node.advertise_joints(fmt::format("{}/{}", map.name, joint_states_topic));
}

void JointStates::publish(Time now) {
  if (!publish_) return;
  known_.clear();
  Time at = now;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto joint = joints_.position(i, now);
    if (!joint) continue;
    known_.push_back({joints_[i].name, joint->position});
    at = std::min(at, joint->at);
  }
  if (known_.empty() || at <= last_) return;
  last_ = at;
  wall_.measure();
  publish_(known_, wall_.of(at));
}

}  // namespace coupler::host
