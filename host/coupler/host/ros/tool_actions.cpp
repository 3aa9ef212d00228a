// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/tool_actions.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"

namespace coupler::host {
namespace {

using How = ToolResult::How;

constexpr double unknown_position = std::numeric_limits<double>::quiet_NaN();

GoalEnd end_of(How how) {
  switch (how) {
    case How::reached:
    case How::holds: return GoalEnd::succeeded;
    case How::replaced: return GoalEnd::replaced;
    case How::cancelled: return GoalEnd::cancelled;
    case How::stuck:
    case How::aborted: break;
  }
  return GoalEnd::aborted;
}

GripperState state_of(const ToolResult& result) {
  return {result.position.value_or(unknown_position), result.how == How::holds || result.how == How::stuck,
          result.how == How::reached};
}

}  // namespace

std::string ToolActions::name_of(std::size_t tool, std::string_view action) const {
  return fmt::format("{}/{}", map_.tools[tool].name, action);
}

bool ToolActions::is_free(std::size_t tool, std::string_view action) const {
  return !is_taken(map_, name_of(tool, action));
}

void ToolActions::offer() {
  bool is_built_in = true;
  const auto keep = [&](std::unique_ptr<GripperServer> server) {
    if (server) servers_.push_back(std::move(server));
  };
  for (std::size_t i = 0; i < map_.tools.size(); ++i) {
    const auto full_name = [&](std::string_view action) {
      return fmt::format("{}/{}", map_.name, name_of(i, action));
    };
    if (is_free(i, gripper_action)) {
      auto server = node_.offer_gripper(full_name(gripper_action), handler(i));
      is_built_in = server != nullptr;
      keep(std::move(server));
    }
    if (is_free(i, parallel_gripper_action))
      keep(node_.offer_parallel_gripper(full_name(parallel_gripper_action), joint_name(map_, map_.tools[i]),
                                        handler(i)));
  }
  if (!is_built_in)
    node_.log(Level::info, fmt::format("{}: the tools have no {}, because this driver was built without "
                                       "control_msgs; docs/driver.md says how to get it",
                                       map_.name, gripper_action));
}

GripperServer::Handler ToolActions::handler(std::size_t tool) {
  return {[this, tool](GripperServer& server, GoalNumber number, Time received, const GripperGoal& goal) {
            begin(tool, server, number, received, goal);
          },
          [this, tool](GripperServer& server, GoalNumber number) {
            tools_.cancel(tool, {&server, number}, std::chrono::steady_clock::now());
          }};
}

/// Returns the end that is nearer to the position, or why the goal is invalid and how to fix it.
tl::expected<ToolEnd, std::string> ToolActions::wanted_end(std::size_t tool, const GripperGoal& goal) const {
  const std::string joint = joint_name(map_, map_.tools[tool]);
  std::optional<double> wanted;
  if (goal.joints.empty() && goal.positions.size() == 1) wanted = goal.positions.front();
  for (std::size_t i = 0; i < std::min(goal.joints.size(), goal.positions.size()); ++i)
    if (goal.joints[i] == joint) wanted = goal.positions[i];
  if (!wanted) return tl::unexpected(fmt::format("it has no position of the joint {}; send one", joint));
  const auto [open, closed] = map_.tools[tool].positions;
  if (!std::isfinite(*wanted))
    return tl::unexpected(
        fmt::format("the position is {}; send {} to open it, {} to close it", *wanted, open, closed));
  return std::abs(*wanted - open) < std::abs(*wanted - closed) ? ToolEnd::open : ToolEnd::closed;
}

void ToolActions::begin(std::size_t tool, GripperServer& server, GoalNumber number, Time received,
                        const GripperGoal& goal) {
  const auto end = wanted_end(tool, goal);
  if (!end) return finish(tool, server, number, {How::aborted, "refused: " + end.error()});
  try {
    {
      const std::lock_guard lock(mutex_);
      running_.push_back({&server, number, tool});
    }
    tools_.begin(
        tool, *end, received,
        [this, tool, &server, number](const ToolResult& result) { finish(tool, server, number, result); },
        {&server, number});
  } catch (const std::exception& error) {  // no memory: the goal ends, and the driver goes on
    finish(tool, server, number, {How::aborted, error.what()});
  }
}

void ToolActions::finish(std::size_t tool, GripperServer& server, GoalNumber number,
                         const ToolResult& result) {
  {
    const std::lock_guard lock(mutex_);
    running_.erase(
        std::remove_if(running_.begin(), running_.end(),
                       [&](const Running& each) { return each.server == &server && each.number == number; }),
        running_.end());
  }
  // In ROS 2 the client does not get the text.
  if (result.how == How::stuck || result.how == How::aborted)
    say(lines_.say(
        fmt::format("{}: a goal of {} was aborted: {}", map_.name, map_.tools[tool].name, result.text),
        std::chrono::steady_clock::now()));
  server.finish(number, end_of(result.how), state_of(result), result.text);
}

void ToolActions::say(const std::optional<std::string>& line) {
  if (line) node_.log(Level::warning, *line);
}

void ToolActions::feed_back(Time now) {
  std::vector<Running> running;
  {
    const std::lock_guard lock(mutex_);
    running = running_;
  }
  say(lines_.due(now));
  for (const auto& [server, number, tool] : running) {
    const auto known = tools_.position(tool, now);
    server->feed_back(number, {known ? known->position : unknown_position, false, false});
  }
}

}  // namespace coupler::host
