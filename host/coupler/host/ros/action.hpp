// SPDX-License-Identifier: Apache-2.0
// The actions that the driver serves, without ROS.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/motion/trajectory_plan.hpp"

namespace coupler::host {

/// A goal of an action, as long as the node is there.
using GoalNumber = std::uint64_t;
enum class GoalEnd : std::uint8_t {
  succeeded,
  aborted,
  replaced,  ///< by a newer goal; ROS 1: preempted, ROS 2: aborted
  cancelled
};

/// An action. The destructor waits until a running handler has returned.
template <class G, class R>
class ServedAction {
 public:
  using Goal = G;
  using Result = R;
  /// The functions that the server calls in a thread of ROS. They must not wait for anything.
  struct Handler {
    /// `received`: before the goal was accepted, after which its client may act.
    std::function<void(ServedAction&, GoalNumber, Time received, const Goal&)> begin;
    std::function<void(ServedAction&, GoalNumber)> cancel;
  };

  virtual ~ServedAction() = default;

  // Any thread may make these calls, which do nothing for a goal that has its result.

  /// `text`: why; only ROS 1 has a place for it.
  virtual void finish(GoalNumber number, GoalEnd how, const Result& result, const std::string& text) = 0;
  /// Does nothing if the action has no feedback.
  virtual void feed_back(GoalNumber number, const Result& as_it_is_now) = 0;
};

struct WaitForGoal {
  std::string point;
  std::string condition;
  std::string value;
  std::chrono::nanoseconds for_at_least{};
  std::chrono::nanoseconds timeout{};
  std::chrono::nanoseconds since{};  ///< wall time; 0: none
};
struct WaitForResult {
  bool met = false;
  std::string value;
  std::chrono::nanoseconds stamp{};  ///< wall time; 0: none
  std::chrono::duration<double> uncertainty{};
  std::string reason;
};
/// coupler_driver/WaitFor.
using WaitForServer = ServedAction<WaitForGoal, WaitForResult>;

/// Positions of joints. GripperCommand has one without the name of its joint.
struct GripperGoal {
  std::vector<std::string> joints;
  std::vector<double> positions;
};
struct GripperState {
  double position = 0;  ///< NaN: it is unknown
  bool stalled = false;
  bool reached_goal = false;
};
/// control_msgs/GripperCommand or control_msgs/ParallelGripperCommand.
using GripperServer = ServedAction<GripperGoal, GripperState>;

/// The result of a trajectory, and what its joints are doing meanwhile.
struct TrajectoryState {
  TrajectoryCode code = TrajectoryCode::successful;
  std::string text;
  std::vector<std::string> joints;  ///< this and what follows is for the feedback
  std::vector<double> desired;
  std::vector<double> actual;  ///< NaN: it is unknown
  std::chrono::nanoseconds from_start{};
  std::chrono::nanoseconds stamp{};  ///< wall time
};
/// control_msgs/FollowJointTrajectory.
using TrajectoryServer = ServedAction<TrajectoryGoal, TrajectoryState>;

}  // namespace coupler::host
