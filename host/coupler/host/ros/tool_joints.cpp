// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/tool_joints.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"

namespace coupler::host {

ToolJoints::ToolJoints(Node& node, const Map& map, Tools& tools) : tools_(tools) {
  for (const Tool& tool : map.tools) names_.push_back(joint_name(map, tool));
  if (find(map, joint_states_topic) == nullptr)
    publish_ = node.advertise_joints(fmt::format("{}/{}", map.name, joint_states_topic));
}

void ToolJoints::publish(Time now) {
  if (!publish_) return;
  known_.clear();
  Time at = now;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto joint = tools_.position(i, now);
    if (!joint) continue;
    known_.push_back({names_[i], joint->position});
    at = std::min(at, joint->at);
  }
  if (known_.empty() || at <= last_) return;
  last_ = at;
  wall_.measure();
  publish_(known_, wall_.of(at));
}

}  // namespace coupler::host
