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
#include "coupler/host/motion/joints.hpp"
#include "coupler/host/motion/step_thread.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/host/motion/trajectories.hpp"
#include "coupler/host/ros/follower.hpp"
#include "coupler/host/ros/joint_states.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/tool_actions.hpp"
#include "coupler/host/ros/trajectory_action.hpp"

namespace coupler::host {

/// Why programs may not write the point directly, and the remedy; empty if they may.
std::string why_not_direct(const Map& map, const Point& point);

/// The tools and axes of a device: for each tool the services `<name>/<tool>/open` and `<name>/<tool>/close`,
/// which answer when it is there, and the latched topic `<name>/<tool>/state`; and what ToolActions,
/// TrajectoryAction and JointStates offer. The services of a tool have two threads: a new call ends the one
/// before, whose thread is free then.
class DeviceMotion final : public Follower, private Sink {
 public:
  /// The requests that it makes of the device. None of them may wait for anything.
  struct Calls {
    std::function<void(const Write&)> write;
    std::function<void(std::uint32_t point)> ask;  ///< reads a point soon whose changes the device announces
    std::function<void(const ScheduledWrite&, Reply<ScheduleAnswer>::Give)> schedule;
    std::function<void(WritesFrom, Reply<CallAnswer>::Give)> cancel;
  };

  /// Shows the states; the services come with begin(). The storage of `map`, the table and the counts must
  /// outlive the result, and each write and each call has its result before its end.
  static std::unique_ptr<Follower> start(Node& node, const Map& map, const ValueTable& values,
                                         SubscriberCounts& subscribers, Calls calls);
  ~DeviceMotion() override;
  DeviceMotion(const DeviceMotion&) = delete;
  DeviceMotion& operator=(const DeviceMotion&) = delete;

  Sink& sink() override { return *this; }
  void begin() override;
  void write_comes(std::uint32_t point) override;
  void safe_comes() override;
  void end_comes() override;
  /// Gives the goals their results.
  void end() override;

 private:
  DeviceMotion(Node& node, const Map& map, const ValueTable& values, SubscriberCounts& subscribers,
               Calls calls);

  void on_values(Span<const std::uint32_t> points) override { tools_.on_values(points, now()); }
  void on_gap() override { tools_.on_gap(now()); }
  void on_no_values(Span<const std::uint32_t> points, Time at) override { tools_.on_no_values(points, at); }
  void on_online(bool online) override;
  void on_scheduled(const ScheduledOutcome& outcome) override;
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
  Joints joints_;
  Trajectories trajectories_;
  JointStates joint_states_;
  PollDeadlines joints_due_;
  ToolActions tool_actions_;
  TrajectoryAction trajectory_action_;
  std::vector<std::unique_ptr<ServiceThread>> services_;  ///< by tool; last: they use the others
};

}  // namespace coupler::host
