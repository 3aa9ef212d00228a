// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// The actions of a device's tools: `<name>/<tool>/gripper_cmd` and, in ROS 2,
/// `<name>/<tool>/parallel_gripper_cmd`. A point with the same name takes precedence.
class ToolActions {
 public:
  /// The storage of `map`, and the tools, must outlive it. Nothing is offered yet.
  ToolActions(Node& node, const Map& map, Tools& tools) : node_(node), map_(map), tools_(tools) {}

  void offer();
  /// Tells the clients of goals where the tools are. Any thread may call it.
  void feed_back(Time now);

 private:
  /// A goal that has no result yet.
  struct Running {
    GripperServer* server;
    GoalNumber number;
    std::size_t tool;
  };

  std::string name_of(std::size_t tool, std::string_view action) const;
  bool is_free(std::size_t tool, std::string_view action) const;
  GripperServer::Handler handler(std::size_t tool);
  tl::expected<ToolEnd, std::string> wanted_end(std::size_t tool, const GripperGoal& goal) const;
  void begin(std::size_t tool, GripperServer& server, GoalNumber number, Time received,
             const GripperGoal& goal);
  void say(const std::optional<std::string>& line);
  void finish(std::size_t tool, GripperServer& server, GoalNumber number, const ToolResult& result);

  Node& node_;
  const Map& map_;
  Tools& tools_;
  LogLineLimit lines_;
  std::mutex mutex_;
  std::vector<Running> running_;
  std::vector<std::unique_ptr<GripperServer>> servers_;  // last: their threads use the others
};

}  // namespace coupler::host
