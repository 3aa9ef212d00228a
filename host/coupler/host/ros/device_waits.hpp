// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/motion/step_thread.hpp"
#include "coupler/host/motion/waits.hpp"
#include "coupler/host/ros/action.hpp"
#include "coupler/host/ros/follower.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// The map asks for the action wait_for, and no point has one of its topics.
bool can_wait_for(const Map& map);

/// The action `<name>/wait_for` of a device, with a thread that gives the results.
class DeviceWaits final : public Follower, private Sink {
 public:
  /// Offers the action and starts the thread. `ask` makes the device read a point soon whose changes it
  /// announces; it must not wait for anything. The storage of `map`, the table and the counts must outlive
  /// the result.
  static std::unique_ptr<Follower> start(Node& node, const Map& map, const ValueTable& values,
                                         SubscriberCounts& subscribers,
                                         std::function<void(std::uint32_t point)> ask);
  ~DeviceWaits() override;
  DeviceWaits(const DeviceWaits&) = delete;
  DeviceWaits& operator=(const DeviceWaits&) = delete;

  Sink& sink() override { return *this; }
  void wanted(std::uint32_t point) override { waits_.on_wanted(point); }
  void end_comes() override { waits_.end("the driver ends"); }
  /// Gives the goals their results.
  void end() override;

 private:
  DeviceWaits(Node& node, const Map& map, const ValueTable& values, SubscriberCounts& subscribers,
              std::function<void(std::uint32_t point)> ask);

  void on_values(Span<const std::uint32_t> points) override { waits_.on_values(points, false); }
  void on_told(std::uint32_t point) override { waits_.on_values({&point, 1}, true); }
  void on_gap() override { waits_.on_gap(); }
  void on_no_values(Span<const std::uint32_t> points, Time at) override { waits_.on_no_values(points, at); }
  void on_online(bool online) override { waits_.on_online(online, std::chrono::steady_clock::now()); }
  void on_report(Level /*level*/, const std::string& /*text*/) override {}

  tl::expected<WaitGoal, std::string> understood(const WaitForGoal& goal, Time now) const;
  void begin(WaitForServer& server, GoalNumber number, Time received, const WaitForGoal& goal);
  void finish(WaitForServer& server, GoalNumber number, std::uint32_t point, const WaitResult& result);

  const Map map_;
  SubscriberCounts& subscribers_;
  StepThread thread_;
  Waits waits_;
  std::unique_ptr<WaitForServer> server_;
};

}  // namespace coupler::host
