// SPDX-License-Identifier: Apache-2.0
// The actions of Ros2Node.
#include <coupler_driver/action/wait_for.hpp>
#ifdef COUPLER_WITH_CONTROL_MSGS
#include <control_msgs/action/follow_joint_trajectory.hpp>
#include <control_msgs/action/gripper_command.hpp>
#endif
#ifdef COUPLER_WITH_PARALLEL_GRIPPER
#include <control_msgs/action/parallel_gripper_command.hpp>
#endif

#include <utility>

#include "coupler/host/ros/action_templates.hpp"
#include "coupler/host/ros2/node.hpp"
#include "coupler/host/ros2/rcl/action.hpp"

namespace coupler::host {

std::unique_ptr<WaitForServer> Ros2Node::offer_wait_for(const std::string& name,
                                                        WaitForServer::Handler handler) {
  remappings_.add_name(name, false);
  using Server = rcl::TypedActionServer<coupler_driver::action::WaitFor>;
  return std::make_unique<TypedAction<WaitForServer, Server, WaitForMessages>>(node_, name, WaitForMessages(),
                                                                               std::move(handler));
}

#ifdef COUPLER_WITH_CONTROL_MSGS
std::unique_ptr<GripperServer> Ros2Node::offer_gripper(const std::string& name,
                                                       GripperServer::Handler handler) {
  remappings_.add_name(name, false);
  using Server = rcl::TypedActionServer<control_msgs::action::GripperCommand>;
  return std::make_unique<TypedAction<GripperServer, Server, GripperMessages>>(node_, name, GripperMessages(),
                                                                               std::move(handler));
}

std::unique_ptr<TrajectoryServer> Ros2Node::offer_trajectories(const std::string& name,
                                                               TrajectoryServer::Handler handler) {
  remappings_.add_name(name, false);
  using Server = rcl::TypedActionServer<control_msgs::action::FollowJointTrajectory>;
  return std::make_unique<TypedAction<TrajectoryServer, Server, TrajectoryMessages>>(
      node_, name, TrajectoryMessages(), std::move(handler));
}
#else
std::unique_ptr<TrajectoryServer> Ros2Node::offer_trajectories(const std::string& /*name*/,
                                                               TrajectoryServer::Handler /*handler*/) {
  return nullptr;
}

std::unique_ptr<GripperServer> Ros2Node::offer_gripper(const std::string& /*name*/,
                                                       GripperServer::Handler /*handler*/) {
  return nullptr;
}
#endif

#ifdef COUPLER_WITH_PARALLEL_GRIPPER
std::unique_ptr<GripperServer> Ros2Node::offer_parallel_gripper(const std::string& name,
                                                                const std::string& joint,
                                                                GripperServer::Handler handler) {
  remappings_.add_name(name, false);
  using Server = rcl::TypedActionServer<control_msgs::action::ParallelGripperCommand>;
  return std::make_unique<TypedAction<GripperServer, Server, ParallelGripperMessages>>(
      node_, name, ParallelGripperMessages{joint}, std::move(handler));
}
#else
std::unique_ptr<GripperServer> Ros2Node::offer_parallel_gripper(const std::string& /*name*/,
                                                                const std::string& /*joint*/,
                                                                GripperServer::Handler /*handler*/) {
  return nullptr;
}
#endif

}  // namespace coupler::host
