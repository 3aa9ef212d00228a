// SPDX-License-Identifier: Apache-2.0
// Plans the changes that the joints of a device make for a trajectory.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/motion/axis_value.hpp"
#include "coupler/host/motion/joints.hpp"

namespace coupler::host {

/// The error codes of control_msgs/FollowJointTrajectory.
enum class TrajectoryCode : int {
  successful = 0,
  invalid_goal = -1,
  invalid_joints = -2,
  old_header_timestamp = -3,
  path_tolerance_violated = -4,
  goal_tolerance_violated = -5
};

/// A goal of control_msgs/FollowJointTrajectory.
struct TrajectoryGoal {
  struct Waypoint {
    std::vector<double> positions;  ///< one for each joint
    std::chrono::nanoseconds from_start{};
  };
  struct Tolerance {
    std::string joint;
    double position = 0;  ///< the most that the joint may be away from its last position; 0 or less: any
  };
  std::vector<std::string> joints;
  std::vector<Waypoint> points;
  std::chrono::nanoseconds start{};  ///< wall time; 0: when it is received
  std::vector<Tolerance> goal_tolerance;
  std::chrono::nanoseconds goal_time_tolerance{};  ///< 0: a second
  bool is_multi_dof = false;                       ///< it also has joints of several degrees of freedom
};

/// Why a trajectory is refused, and what may be sent.
struct TrajectoryError {
  TrajectoryCode code;
  std::string text;
};

/// One thing to do.
struct JointChange {
  Duration at{};          ///< from the start of the trajectory
  std::size_t joint = 0;  ///< index into Joints
  ToolEnd end{};          ///< of a tool: where to drive it
  AxisRegisters value{};  ///< of an axis
  double position = 0;    ///< what the joint then has
};

struct TrajectoryPlan {
  struct Tolerance {
    std::size_t joint;  ///< index into Joints
    double last;        ///< position
    double most;        ///< away from it
  };
  std::vector<std::size_t> joints;    ///< indices into Joints, in the order of the goal
  std::vector<JointChange> changes;   ///< by time
  std::vector<Tolerance> tolerances;  ///< of axes, whose position is read back
  Duration time_tolerance{};          ///< after the end an axis may still come into its tolerance
  std::vector<TrajectoryGoal::Waypoint> points;

  Duration duration() const { return points.back().from_start; }
  /// Returns where a joint of the goal is to be then, on the straight line between the points.
  double position_at(std::size_t joint_of_goal, Duration from_start) const;
};

/// The most points of a trajectory, and the most changes that they may make.
constexpr std::size_t most_waypoints = 10'000;
constexpr std::size_t most_changes = 10'000;

/// Plans a trajectory. Each joint goes where the first point wants it, except for a tool that is to be nearly
/// in the middle then, since one that holds a part is there. Later, a tool, or an axis with Axis::positions,
/// changes where the straight line between two points crosses the middle between two positions; at the exact
/// middle the higher position counts. Another axis has the value of each point from its time on. Errors:
/// invalid_goal and invalid_joints.
tl::expected<TrajectoryPlan, TrajectoryError> plan_trajectory(TrajectoryGoal goal, const Joints& joints);

}  // namespace coupler::host
