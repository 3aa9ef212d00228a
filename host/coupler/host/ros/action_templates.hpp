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
