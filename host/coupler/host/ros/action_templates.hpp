// SPDX-License-Identifier: Apache-2.0
// The messages of the driver's actions, which both ROSes fill alike.
#pragma once

#include <string>
#include <utility>

#include "coupler/host/ros/action.hpp"
#include "coupler/host/ros/message_time.hpp"

namespace coupler::host {

/// Serves an action by an action server of a ROS. `Messages` has goal(message), put_result(message, result)
/// and put_feedback(message, result).
template <class Action, class Server, class Messages>
class TypedAction : public Action {
 public:
  template <class Place>
  TypedAction(Place& place, const std::string& name, Messages messages, typename Action::Handler handler)
      : messages_(std::move(messages)),
        server_(
            place, name,
            [this, begin = std::move(handler.begin)](GoalNumber number, Time received,
                                                     const typename Server::Goal& goal) {
              begin(*this, number, received, messages_.goal(goal));
            },
            [this, cancel = std::move(handler.cancel)](GoalNumber number) { cancel(*this, number); }) {}

  void finish(GoalNumber number, GoalEnd how, const typename Action::Result& result,
              const std::string& text) override {
    typename Server::Result message;
    messages_.put_result(message, result);
    server_.finish(number, how, message, text);
  }
  void feed_back(GoalNumber number, const typename Action::Result& now) override {
    typename Server::Feedback message;
    messages_.put_feedback(message, now);
    server_.feed_back(number, message);
  }

 private:
  Messages messages_;
  Server server_;
};

/// coupler_driver/WaitFor.
struct WaitForMessages {
  template <class Message>
  static WaitForGoal goal(const Message& goal) {
    return {goal.point,
            goal.condition,
            goal.value,
            message_time(goal.for_at_least),
            message_time(goal.timeout),
            message_time(goal.since)};
  }
  template <class Message>
  static void put_result(Message& message, const WaitForResult& result) {
    message.met = result.met;
    message.value = result.value;
    put_time(message.stamp, result.stamp);
    message.uncertainty = result.uncertainty.count();
    message.reason = result.reason;
  }
  template <class Message>
  static void put_feedback(Message& /*message*/, const WaitForResult& /*now*/) {}
};

/// control_msgs/GripperCommand.
struct GripperMessages {
  template <class Message>
  static GripperGoal goal(const Message& goal) {
    return {{}, {goal.command.position}};
  }
  template <class Message>
  static void put_result(Message& message, const GripperState& state) {
    message.position = state.position;
    message.stalled = state.stalled;
    message.reached_goal = state.reached_goal;
  }
  template <class Message>
  static void put_feedback(Message& message, const GripperState& now) {
    put_result(message, now);
  }
};

/// control_msgs/FollowJointTrajectory.
struct TrajectoryMessages {
  template <class Message>
  static TrajectoryGoal goal(const Message& goal) {
    TrajectoryGoal wanted;
    wanted.joints.assign(goal.trajectory.joint_names.begin(), goal.trajectory.joint_names.end());
    for (const auto& point : goal.trajectory.points)
      wanted.points.push_back(
          {{point.positions.begin(), point.positions.end()}, message_time(point.time_from_start)});
    wanted.start = message_time(goal.trajectory.header.stamp);
    for (const auto& tolerance : goal.goal_tolerance)
      wanted.goal_tolerance.push_back({tolerance.name, tolerance.position});
    wanted.goal_time_tolerance = message_time(goal.goal_time_tolerance);
    wanted.is_multi_dof = is_multi_dof(goal, 0);
    return wanted;
  }
  template <class Message>
  static void put_result(Message& message, const TrajectoryState& result) {
    message.error_code = static_cast<int>(result.code);
    message.error_string = result.text;
  }
  template <class Message>
  static void put_feedback(Message& message, const TrajectoryState& now) {
    put_time(message.header.stamp, now.stamp);
    message.joint_names = {now.joints.begin(), now.joints.end()};
    message.desired.positions = {now.desired.begin(), now.desired.end()};
    message.actual.positions = {now.actual.begin(), now.actual.end()};
    for (std::size_t i = 0; i < now.desired.size(); ++i)
      message.error.positions.push_back(now.desired[i] - now.actual[i]);
    for (auto* point : {&message.desired, &message.actual, &message.error})
      put_time(point->time_from_start, now.from_start);
  }

 private:
  /// Only ROS 2's goals have a trajectory of several degrees of freedom.
  template <class Message>
  static auto is_multi_dof(const Message& goal, int /*preferred*/)
      -> decltype(!goal.multi_dof_trajectory.points.empty()) {
    return !goal.multi_dof_trajectory.points.empty();
  }
  template <class Message>
  static bool is_multi_dof(const Message& /*goal*/, long /*otherwise*/) {
    return false;
  }
};

/// control_msgs/ParallelGripperCommand, of one joint.
struct ParallelGripperMessages {
  std::string joint;

  template <class Message>
  static GripperGoal goal(const Message& goal) {
    return {{goal.command.name.begin(), goal.command.name.end()},
            {goal.command.position.begin(), goal.command.position.end()}};
  }
  template <class Message>
  void put_result(Message& message, const GripperState& state) const {
    put_feedback(message, state);
    message.stalled = state.stalled;
    message.reached_goal = state.reached_goal;
  }
  template <class Message>
  void put_feedback(Message& message, const GripperState& now) const {
    message.state.name = {joint};
    message.state.position = {now.position};
  }
};

}  // namespace coupler::host
