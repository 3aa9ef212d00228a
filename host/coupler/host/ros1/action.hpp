// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/action_server.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "coupler/host/ros/action.hpp"

namespace coupler::host {

/// Serves the action A in a thread of its own. Each goal is accepted, and ends with one call of finish().
template <class A>
class TypedActionServer {
 public:
  using Goal = typename A::_action_goal_type::_goal_type;
  using Result = typename A::_action_result_type::_result_type;
  using Feedback = typename A::_action_feedback_type::_feedback_type;

  /// `begin` and `cancel` are called in that thread.
  TypedActionServer(const ros::NodeHandle& handle, const std::string& name,
                    std::function<void(GoalNumber, Time received, const Goal&)> begin,
                    std::function<void(GoalNumber)> cancel)
      : begin_(std::move(begin)), cancel_(std::move(cancel)), server_(with_queue(handle), name, false) {
    server_.registerGoalCallback([this](const Handle& goal) { take(goal); });
    server_.registerCancelCallback([this](const Handle& goal) { cancel_(number_of(goal)); });
    server_.start();
    thread_ = std::thread([this] {
      while (queue_.isEnabled()) queue_.callOne(ros::WallDuration(3600));  // disable() ends the wait
    });
  }
  ~TypedActionServer() {
    queue_.disable();
    thread_.join();
  }
  TypedActionServer(const TypedActionServer&) = delete;
  TypedActionServer& operator=(const TypedActionServer&) = delete;

  // Any thread may make these calls.

  void finish(GoalNumber number, GoalEnd how, const Result& result, const std::string& text) {
    auto goal = running(number, true);
    if (!goal) return;
    switch (how) {
      case GoalEnd::succeeded: return goal->setSucceeded(result, text);
      case GoalEnd::aborted: return goal->setAborted(result, text);
      case GoalEnd::replaced:
      case GoalEnd::cancelled: return goal->setCanceled(result, text);
    }
  }
  void feed_back(GoalNumber number, const Feedback& feedback) {
    if (auto goal = running(number, false)) goal->publishFeedback(feedback);
  }

 private:
  using Server = actionlib::ActionServer<A>;
  using Handle = typename Server::GoalHandle;

  ros::NodeHandle with_queue(ros::NodeHandle handle) {
    handle.setCallbackQueue(&queue_);
    return handle;
  }

  void take(Handle goal) {
    const Time received = std::chrono::steady_clock::now();
    goal.setAccepted();
    GoalNumber number = 0;
    {
      const std::lock_guard lock(mutex_);
      number = ++last_;
      goals_.emplace(number, goal);
    }
    begin_(number, received, *goal.getGoal());
  }

  /// Returns a goal that has no result yet; `ends`: it gets one now.
  std::optional<Handle> running(GoalNumber number, bool ends) {
    const std::lock_guard lock(mutex_);
    const auto at = goals_.find(number);
    if (at == goals_.end()) return std::nullopt;
    Handle goal = at->second;
    if (ends) goals_.erase(at);
    return goal;
  }

  /// 0, which none has, if it has its result.
  GoalNumber number_of(const Handle& goal) {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, each] : goals_)
      if (each == goal) return number;
    return 0;
  }

  std::function<void(GoalNumber, Time received, const Goal&)> begin_;
  std::function<void(GoalNumber)> cancel_;
  std::mutex mutex_;
  std::map<GoalNumber, Handle> goals_;  ///< that have no result yet
  GoalNumber last_ = 0;
  ros::CallbackQueue queue_;
  Server server_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
