// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectory_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/nearest.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

using Waypoint = TrajectoryGoal::Waypoint;

/// How far a position may be outside those of its joint, and a first position from an end of a tool, as a
/// fraction of their distance.
constexpr double margin = 0.1;
/// See TrajectoryGoal::goal_time_tolerance.
constexpr std::chrono::seconds usual_tolerance(1);

TrajectoryError invalid(std::string text) { return {TrajectoryCode::invalid_goal, std::move(text)}; }

/// One of the positions of a joint, and what leads there.
struct Stop {
  double position = 0;
  ToolEnd end{};
  AxisRegisters value{};
};

/// Returns the positions in ascending order; none for an axis whose position is its value.
std::vector<Stop> stops_of(const Joints::Joint& joint) {
  std::vector<Stop> stops;
  if (joint.tool != nullptr) {
    const auto [open, closed] = joint.tool->positions;
    stops = {{open, ToolEnd::open, {}}, {closed, ToolEnd::closed, {}}};
    if (closed < open) std::swap(stops[0], stops[1]);
  } else {
    for (const AxisPosition& known : joint.axis->positions)
      stops.push_back({known.position, {}, encode_value(*joint.point, known.value)});
  }
  return stops;
}

/// Makes the changes of one joint.
class JointPlanner {
 public:
  JointPlanner(const Joints::Joint& joint, std::size_t index, std::vector<JointChange>& changes)
      : joint_(joint), index_(index), stops_(stops_of(joint)), changes_(changes) {}

  /// Returns what is wrong with the position, and what may be sent; empty: nothing.
  std::string why_wrong(double position) const {
    if (!std::isfinite(position)) return fmt::format("{} is not a position; send a finite number", position);
    if (stops_.empty()) {
      const auto value = encode_position(*joint_.point, position);
      return value ? std::string() : value.error();
    }
    const double lowest = stops_.front().position, highest = stops_.back().position;
    const double beyond = margin * (highest - lowest);
    if (position >= lowest - beyond && position <= highest + beyond) return {};
    return fmt::format("{} is too far outside its positions; send {} to {}", position, lowest, highest);
  }

  void first(const Waypoint& point, double position) {
    if (stops_.empty()) return change_value(point.from_start, position);
    begun_at_ = position;
    stop_ = nearest(position);
    if (joint_.tool != nullptr && std::abs(position - stops_[*stop_].position) > margin * span())
      stop_.reset();
    else
      change(point.from_start, *stop_);
  }

  void next(const Waypoint& from, double from_position, const Waypoint& to, double to_position) {
    if (stops_.empty()) return change_value(to.from_start, to_position);
    if (!stop_) {  // a tool between its ends: where the line leads decides
      const double moved = to_position - begun_at_;
      const std::size_t end = moved > 0 ? 1 : 0;
      if (std::abs(moved) > margin * span() && nearest(to_position) == end) change(from.from_start, end);
      return;
    }
    const auto crossing = [&](std::size_t middle) {
      const double part = (middle_of(middle) - from_position) / (to_position - from_position);
      const std::chrono::duration<double, std::nano> whole(to.from_start - from.from_start);
      return from.from_start + std::chrono::duration_cast<std::chrono::nanoseconds>(part * whole);
    };
    const std::size_t last = nearest(to_position);
    while (*stop_ < last) change(crossing(*stop_), *stop_ + 1);
    while (*stop_ > last) change(crossing(*stop_ - 1), *stop_ - 1);
  }

 private:
  double middle_of(std::size_t stop) const {
    return stops_[stop].position + (stops_[stop + 1].position - stops_[stop].position) / 2;
  }
  std::size_t nearest(double position) const {
    std::size_t stop = 0;
    while (stop + 1 < stops_.size() && position >= middle_of(stop)) ++stop;
    return stop;
  }
  double span() const { return stops_.back().position - stops_.front().position; }
  void change(Duration at, std::size_t stop) {
    stop_ = stop;
    changes_.push_back({at, index_, stops_[stop].end, stops_[stop].value, stops_[stop].position});
  }
  void change_value(Duration at, double position) {
    const auto value = encode_position(*joint_.point, position);
    if (!value || value_ == *value) return;
    value_ = *value;
    changes_.push_back({at, index_, {}, *value, position});
  }

  const Joints::Joint& joint_;
  std::size_t index_;
  std::vector<Stop> stops_;
  std::optional<std::size_t> stop_;     ///< where it is to be; nothing: between the ends of a tool
  double begun_at_ = 0;                 ///< the first position
  std::optional<AxisRegisters> value_;  ///< what an axis without positions is to have
  std::vector<JointChange>& changes_;
};

tl::expected<std::vector<std::size_t>, TrajectoryError> find_joints(const TrajectoryGoal& goal,
                                                                    const Joints& joints) {
  const auto wrong = [](std::string text) {
    return tl::unexpected(TrajectoryError{TrajectoryCode::invalid_joints, std::move(text)});
  };
  if (goal.joints.empty()) return wrong("it names no joints; name them in joint_names");
  std::vector<std::size_t> found;
  for (const std::string& name : goal.joints) {
    const auto joint = joints.find(name);
    if (!joint)
      return wrong(fmt::format(
          "there is no joint {}; {}", excerpt(name),
          nearest_or(name, joints.names(),
                     "its joints are those of the map's tools and axes; 'coupler plan MAP' lists them")));
    if (std::find(found.begin(), found.end(), *joint) != found.end())
      return wrong(fmt::format("it names the joint {} twice; name it once", name));
    found.push_back(*joint);
  }
  return found;
}

/// Returns what is wrong with the points as such; empty: nothing.
std::string why_wrong(const TrajectoryGoal& goal) {
  if (goal.is_multi_dof) return "it has a multi_dof_trajectory; put tools and axes into its trajectory only";
  if (goal.points.empty()) return "it has no points; send one or more";
  if (goal.points.size() > most_waypoints)
    return fmt::format("it has {} points; send at most {}", goal.points.size(), most_waypoints);
  const Waypoint* before = nullptr;
  for (std::size_t i = 0; i < goal.points.size(); ++i) {
    const Waypoint& point = goal.points[i];
    if (point.positions.size() != goal.joints.size())
      return fmt::format("its point {} has {} positions for {} joints; send one for each joint", i,
                         point.positions.size(), goal.joints.size());
    if (point.from_start < std::chrono::nanoseconds::zero())
      return fmt::format("the time_from_start of its point {} is negative; send 0 or more", i);
    if (before != nullptr && point.from_start <= before->from_start)
      return fmt::format(
          "the time_from_start of its point {} is not later than that of the point before; send "
          "times that increase from point to point",
          i);
    before = &point;
  }
  return {};
}

tl::expected<std::vector<TrajectoryPlan::Tolerance>, TrajectoryError> find_tolerances(
    const TrajectoryGoal& goal, const Joints& joints) {
  std::vector<TrajectoryPlan::Tolerance> tolerances;
  for (const auto& [name, most] : goal.goal_tolerance) {
    const auto named = std::find(goal.joints.begin(), goal.joints.end(), name);
    if (named == goal.joints.end())
      return tl::unexpected(invalid(fmt::format(
          "its goal_tolerance names {}, which is not one of its joints; leave it out", excerpt(name))));
    const std::size_t joint = *joints.find(name);
    const double last = goal.points.back().positions[static_cast<std::size_t>(named - goal.joints.begin())];
    if (most > 0 && joints[joint].axis != nullptr && is_readable(*joints[joint].point))
      tolerances.push_back({joint, last, most});
  }
  return tolerances;
}

}  // namespace

double TrajectoryPlan::position_at(std::size_t joint_of_goal, Duration from_start) const {
  const auto next = std::upper_bound(
      points.begin(), points.end(), from_start,
      [](Duration time, const Waypoint& point) { return time < Duration(point.from_start); });
  if (next == points.begin()) return points.front().positions[joint_of_goal];
  const Waypoint& before = *std::prev(next);
  const double from = before.positions[joint_of_goal];
  if (next == points.end()) return from;
  const double part = std::chrono::duration<double>(from_start - before.from_start) /
                      std::chrono::duration<double>(next->from_start - before.from_start);
  return from + (next->positions[joint_of_goal] - from) * part;
}

tl::expected<TrajectoryPlan, TrajectoryError> plan_trajectory(TrajectoryGoal goal, const Joints& joints) {
  TrajectoryPlan plan;
  const auto found = find_joints(goal, joints);
  if (!found) return tl::unexpected(found.error());
  plan.joints = *found;
  if (auto wrong = why_wrong(goal); !wrong.empty()) return tl::unexpected(invalid(std::move(wrong)));
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    JointPlanner planner(joints[plan.joints[i]], plan.joints[i], plan.changes);
    const Waypoint* before = nullptr;
    for (std::size_t p = 0; p < goal.points.size(); ++p) {
      const Waypoint& point = goal.points[p];
      if (const auto wrong = planner.why_wrong(point.positions[i]); !wrong.empty())
        return tl::unexpected(invalid(
            fmt::format("the position of {} in its point {} is wrong: {}", goal.joints[i], p, wrong)));
      if (before == nullptr)
        planner.first(point, point.positions[i]);
      else
        planner.next(*before, before->positions[i], point, point.positions[i]);
      before = &point;
      if (plan.changes.size() > most_changes)
        return tl::unexpected(
            invalid(fmt::format("it makes more than {} changes; send a shorter trajectory", most_changes)));
    }
  }
  std::stable_sort(plan.changes.begin(), plan.changes.end(),
                   [](const JointChange& a, const JointChange& b) { return a.at < b.at; });
  auto tolerances = find_tolerances(goal, joints);
  if (!tolerances) return tl::unexpected(tolerances.error());
  plan.tolerances = std::move(*tolerances);
  plan.time_tolerance = goal.goal_time_tolerance > std::chrono::nanoseconds::zero() ? goal.goal_time_tolerance
                                                                                    : usual_tolerance;
  plan.points = std::move(goal.points);
  return plan;
}

}  // namespace coupler::host
