// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/motion/step_thread.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/host/ros/follower.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/tool_actions.hpp"
#include "coupler/host/ros/tool_joints.hpp"

namespace coupler::host {

/// Why programs may not write the point directly, and the remedy; empty if they may.
std::string why_not_direct(const Map& map, const Point& point);

/// The tools of a device: the services `<name>/<tool>/open` and `<name>/<tool>/close`, which answer when the
/// tool is there, the latched topic `<name>/<tool>/state`, and what ToolActions and ToolJoints offer. The
/// services of a tool have two threads: a new call ends the one before, whose thread is free then.
class DeviceTools final : public Follower, private Sink {
 public:
  /// Shows the states; the services come with begin(). `write` sends a write, and `ask` makes the device read
  /// a point soon whose changes it announces; neither may wait for anything. The storage of `map`, the table
  /// and the counts must outlive the result, and each write has its result before its end.
  static std::unique_ptr<Follower> start(Node& node, const Map& map, const ValueTable& values,
                                         SubscriberCounts& subscribers,
                                         std::function<void(const Write&)> write,
                                         std::function<void(std::uint32_t point)> ask);
  ~DeviceTools() override;
  DeviceTools(const DeviceTools&) = delete;
  DeviceTools& operator=(const DeviceTools&) = delete;

  Sink& sink() override { return *this; }
  void begin() override;
  void write_comes(std::uint32_t point) override;
  void safe_comes() override;
  void end_comes() override;
  /// Gives the goals their results.
  void end() override;

 private:
  DeviceTools(Node& node, const Map& map, const ValueTable& values, SubscriberCounts& subscribers,
              std::function<void(const Write&)> write, std::function<void(std::uint32_t)> ask);

  void on_values(Span<const std::uint32_t> points) override { tools_.on_values(points, now()); }
  void on_gap() override { tools_.on_gap(now()); }
  void on_no_values(Span<const std::uint32_t> points, Time at) override { tools_.on_no_values(points, at); }
  void on_online(bool online) override { tools_.on_online(online, now()); }
  void on_report(Level /*level*/, const std::string& /*text*/) override {}

  static Time now() { return std::chrono::steady_clock::now(); }
  Time step(Time now);
  void offer(std::size_t tool, ServiceThread& service, ToolEnd end);
  void show(std::size_t tool, const ToolStatus& status);
  CallAnswer answer(std::size_t tool, ToolEnd end);

  Node& node_;
  const Map map_;
  std::vector<Node::PublishToolState> publish_;  ///< by tool; empty where a point has the topic
  StepThread thread_;
  Tools tools_;
  ToolJoints joints_;
  PollDeadlines joints_due_;
  ToolActions actions_;
  std::vector<std::unique_ptr<ServiceThread>> services_;  ///< by tool; last: they use the others
};

}  // namespace coupler::host
