// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler {

// Names of the driver for MoveIt: a topic and an action below the map's name, and actions below a tool's.
constexpr std::string_view joint_states_topic = "joint_states";
constexpr std::string_view trajectory_action = "follow_joint_trajectory";
constexpr std::string_view gripper_action = "gripper_cmd";
constexpr std::string_view parallel_gripper_action = "parallel_gripper_cmd";

/// Returns whether the map says anything of the tool as a joint.
inline bool is_described_as_joint(const Tool& tool) {
  return !tool.joint.empty() || tool.positions != JointPositions{};
}

/// The name of a tool or an axis as a joint: "clamp_joint", or "NAME/clamp" if the map gives it none.
template <class ToolOrAxis>
std::string joint_name(const Map& map, const ToolOrAxis& of) {
  if (!of.joint.empty()) return std::string(of.joint);
  return std::string(map.name) + '/' + std::string(of.name);
}

}  // namespace coupler
