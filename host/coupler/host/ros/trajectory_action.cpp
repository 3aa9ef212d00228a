// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/trajectory_action.hpp"

#include <cmath>
#include <exception>
#include <limits>

#include <fmt/format.h>

#include "coupler/host/core/wall_time.hpp"
#include "coupler/map/joint.hpp"

namespace coupler::host {
namespace {

GoalEnd end_of(TrajectoryResult::How how) {
  switch (how) {
    case TrajectoryResult::How::done: return GoalEnd::succeeded;
    case TrajectoryResult::How::replaced: return GoalEnd::replaced;
    case TrajectoryResult::How::cancelled: return GoalEnd::cancelled;
    case TrajectoryResult::How::aborted: break;
  }
  return GoalEnd::aborted;
}

void finish(TrajectoryServer& server, GoalNumber number, const TrajectoryResult& result) {
  TrajectoryState state;
  state.code = result.code;
  state.text = result.text;
  server.finish(number, end_of(result.how), state, result.text);
}

}  // namespace

void TrajectoryAction::offer() {
  if (is_taken(map_, trajectory_action)) return;
  server_ =
      node_.offer_trajectories(fmt::format("{}/{}", map_.name, trajectory_action),
                               {[this](TrajectoryServer& server, GoalNumber number, Time received,
                                       const TrajectoryGoal& goal) { begin(server, number, received, goal); },
                                [this](TrajectoryServer& server, GoalNumber number) {
                                  trajectories_.cancel({&server, number});
                                }});
  if (server_ == nullptr && !map_.axes.empty())
    node_.log(Level::info,
              fmt::format("{}: there is no {}, because this driver was built without control_msgs; "
                          "docs/driver.md says how to get it",
                          map_.name, trajectory_action));
}

void TrajectoryAction::begin(TrajectoryServer& server, GoalNumber number, Time received,
                             const TrajectoryGoal& goal) {
  serving_ = &server;
  try {
    trajectories_.begin({&server, number}, goal, received, [&server, number](const TrajectoryResult& result) {
      finish(server, number, result);
    });
  } catch (const std::exception& error) {  // no memory: the goal ends, and the driver goes on
    finish(server, number, {TrajectoryResult::How::aborted, TrajectoryCode::invalid_goal, error.what()});
  }
}

void TrajectoryAction::feed_back(Time now) {
  TrajectoryServer* const server = serving_;
  const auto progress = server == nullptr ? std::nullopt : trajectories_.progress(now);
  if (!progress) return;
  TrajectoryState state;
  state.desired = progress->desired;
  state.from_start = progress->from_start;
  state.stamp = measured_wall_time().of(now);
  for (const std::size_t joint : progress->joints) {
    const auto is = joints_.position(joint, now);
    state.joints.push_back(joints_[joint].name);
    state.actual.push_back(is ? is->position : std::numeric_limits<double>::quiet_NaN());
  }
  server->feed_back(progress->key.number, state);
}

}  // namespace coupler::host
