// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/time.h>
#include <rcl_action/rcl_action.h>
#include <action_msgs/msg/goal_status.hpp>
#include <action_msgs/srv/cancel_goal.hpp>
#include <rosidl_typesupport_cpp/action_type_support.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/ros/action.hpp"
#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// The part of an action server that does not depend on the action's type. rcl's calls for a server are made
/// under one lock.
class ActionServer {
 public:
  using Uuid = std::array<std::uint8_t, UUID_SIZE>;
  using RequestId = rmw_request_id_t;

  ActionServer(const ActionServer&) = delete;
  ActionServer& operator=(const ActionServer&) = delete;

 protected:
  /// Throws Error.
  ActionServer(Node& node, std::string name, const rosidl_action_type_support_t* type,
               std::function<void(host::GoalNumber)> cancel);
  ~ActionServer();

  /// Takes what comes from now on. `take_goal` and `take_result` take one request each, in the inbox's
  /// thread; false: there is none. Throws Error.
  void listen(std::function<bool()> take_goal, std::function<bool()> take_result);
  /// The goals are cancelled no more. To be called before what the calls use is destroyed.
  void stop_listening();

  // The lock is held.

  /// Returns the number of the new goal, and the time at which it was accepted; nothing if it cannot be one.
  std::optional<host::GoalNumber> accept(const Uuid& id, builtin_interfaces::msg::Time& at);
  bool exists(const Uuid& id) const;
  /// Returns the id of a goal that has no result yet.
  std::optional<Uuid> running(host::GoalNumber number) const;
  /// Returns its id and its status now; nothing if there is no such goal, or it has ended.
  std::optional<std::pair<Uuid, std::int8_t>> end(host::GoalNumber number, host::GoalEnd how);
  /// Returns the goals whose results nobody may ask for any more.
  std::vector<Uuid> expired();
  void publish_status();
  bool has_taken(rcl_ret_t result);
  void check_answer(rcl_ret_t result);

  rcl_action_server_t* get() { return server_.get(); }

  std::mutex mutex_;

 private:
  bool take_cancel();
  std::vector<host::GoalNumber> cancel_goals(const action_msgs::srv::CancelGoal::Request& request,
                                             action_msgs::srv::CancelGoal::Response& response);

  Node& node_;
  std::string name_;
  std::function<void(host::GoalNumber)> cancel_;
  Handle<rcl_clock_t> clock_;
  Handle<rcl_action_server_t> server_;
  std::map<host::GoalNumber, Uuid> goals_;            ///< that have no result yet
  std::map<Uuid, rcl_action_goal_handle_t> handles_;  ///< of all goals that rcl knows; rcl does not end them
  host::GoalNumber last_ = 0;
  std::optional<Inbox::Source> goal_requests_;  // last: they use the others
  std::optional<Inbox::Source> cancel_requests_;
  std::optional<Inbox::Source> result_requests_;
};

/// Serves the action A. Each goal is accepted, and ends with one call of finish().
template <class A>
class TypedActionServer : ActionServer {
 public:
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;

  /// `begin` and `cancel` are called in the inbox's thread. Throws Error.
  TypedActionServer(Node& node, const std::string& name,
                    std::function<void(host::GoalNumber, host::Time received, const Goal&)> begin,
                    std::function<void(host::GoalNumber)> cancel)
      : ActionServer(node, name, rosidl_typesupport_cpp::get_action_type_support_handle<A>(),
                     std::move(cancel)),
        begin_(std::move(begin)) {
    listen([this] { return take_goal(); }, [this] { return take_result(); });
  }
  ~TypedActionServer() { stop_listening(); }

  // Any thread may make these calls.

  void finish(host::GoalNumber number, host::GoalEnd how, const Result& result, const std::string& /*text*/) {
    const std::lock_guard lock(mutex_);
    const auto ended = end(number, how);
    if (!ended) return;
    Asked& asked = results_[ended->first];
    asked.response.emplace();
    asked.response->status = ended->second;
    asked.response->result = result;
    for (RequestId& id : asked.waiting)
      check_answer(rcl_action_send_result_response(get(), &id, &*asked.response));
    asked.waiting.clear();
  }
  void feed_back(host::GoalNumber number, const Feedback& feedback) {
    const std::lock_guard lock(mutex_);
    const auto id = running(number);
    if (!id) return;
    typename A::Impl::FeedbackMessage message;
    message.goal_id.uuid = *id;
    message.feedback = feedback;
    check_answer(rcl_action_publish_feedback(get(), &message));
  }

 private:
  using ResultResponse = typename A::Impl::GetResultService::Response;
  /// The result of a goal, and the requests that wait for it.
  struct Asked {
    std::optional<ResultResponse> response;
    std::vector<RequestId> waiting;
  };

  bool take_goal() {
    typename A::Impl::SendGoalService::Request request;
    typename A::Impl::SendGoalService::Response response;
    RequestId id;
    std::optional<host::GoalNumber> number;
    const host::Time received = std::chrono::steady_clock::now();
    {
      const std::lock_guard lock(mutex_);
      if (!has_taken(rcl_action_take_goal_request(get(), &id, &request))) return false;
      for (const Uuid& old : expired()) results_.erase(old);
      number = accept(request.goal_id.uuid, response.stamp);
      response.accepted = number.has_value();
      if (number) results_[request.goal_id.uuid];
      check_answer(rcl_action_send_goal_response(get(), &id, &response));
      publish_status();
    }
    if (number) begin_(*number, received, request.goal);
    return true;
  }

  bool take_result() {
    typename A::Impl::GetResultService::Request request;
    RequestId id;
    const std::lock_guard lock(mutex_);
    if (!has_taken(rcl_action_take_result_request(get(), &id, &request))) return false;
    const auto asked = results_.find(request.goal_id.uuid);
    if (asked != results_.end() && !asked->second.response) {
      asked->second.waiting.push_back(id);
      return true;
    }
    ResultResponse unknown;
    unknown.status = action_msgs::msg::GoalStatus::STATUS_UNKNOWN;
    ResultResponse& response = asked == results_.end() ? unknown : *asked->second.response;
    check_answer(rcl_action_send_result_response(get(), &id, &response));
    return true;
  }

  std::function<void(host::GoalNumber, host::Time received, const Goal&)> begin_;
  std::map<Uuid, Asked> results_;
};

}  // namespace coupler::rcl
