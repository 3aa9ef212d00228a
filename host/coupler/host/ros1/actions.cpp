// SPDX-License-Identifier: Apache-2.0
// The actions of Ros1Node.
#include <coupler_driver/WaitForAction.h>
#ifdef COUPLER_WITH_CONTROL_MSGS
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <control_msgs/GripperCommandAction.h>
#endif

#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros/action_templates.hpp"
#include "coupler/host/ros1/action.hpp"
#include "coupler/host/ros1/node.hpp"

namespace coupler::host {

void Ros1Node::note_action(const std::string& name) {
  for (const char* topic : {"cancel", "feedback", "goal", "result", "status"})
    remappings_.add_name(fmt::format("{}/{}", name, topic), false);
}

std::unique_ptr<WaitForServer> Ros1Node::offer_wait_for(const std::string& name,
                                                        WaitForServer::Handler handler) {
  note_action(name);
  using Server = TypedActionServer<coupler_driver::WaitForAction>;
  return std::make_unique<TypedAction<WaitForServer, Server, WaitForMessages>>(
      handle_, name, WaitForMessages(), std::move(handler));
}

#ifdef COUPLER_WITH_CONTROL_MSGS
std::unique_ptr<GripperServer> Ros1Node::offer_gripper(const std::string& name,
                                                       GripperServer::Handler handler) {
  note_action(name);
  using Server = TypedActionServer<control_msgs::GripperCommandAction>;
  return std::make_unique<TypedAction<GripperServer, Server, GripperMessages>>(
      handle_, name, GripperMessages(), std::move(handler));
}

std::unique_ptr<TrajectoryServer> Ros1Node::offer_trajectories(const std::string& name,
                                                               TrajectoryServer::Handler handler) {
  note_action(name);
  using Server = TypedActionServer<control_msgs::FollowJointTrajectoryAction>;
  return std::make_unique<TypedAction<TrajectoryServer, Server, TrajectoryMessages>>(
      handle_, name, TrajectoryMessages(), std::move(handler));
}
#else
std::unique_ptr<TrajectoryServer> Ros1Node::offer_trajectories(const std::string& /*name*/,
                                                               TrajectoryServer::Handler /*handler*/) {
  return nullptr;
}

std::unique_ptr<GripperServer> Ros1Node::offer_gripper(const std::string& /*name*/,
                                                       GripperServer::Handler /*handler*/) {
  return nullptr;
}
#endif

/// ROS 1's control_msgs do not have it.
std::unique_ptr<GripperServer> Ros1Node::offer_parallel_gripper(const std::string& /*name*/,
                                                                const std::string& /*joint*/,
                                                                GripperServer::Handler /*handler*/) {
  return nullptr;
}

}  // namespace coupler::host
