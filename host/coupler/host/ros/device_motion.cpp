// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_motion.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/wall_time.hpp"

namespace coupler::host {
namespace {

/// After a cable is cut, nothing is switched later than the horizon, which is no longer than the node's
/// watchdog lets outputs stay as they are.
Window window_of(const Map& map) {
  Window window;
  if (const Watchdog& watchdog = map.service.watchdog; watchdog.present())
    window.horizon = std::min<Duration>(window.horizon, watchdog.timeout);
  return window;
}

}  // namespace

std::string why_not_direct(const Map& map, const Point& point) {
  const Tool* tool = tool_with_output(map, point.name);
  if (tool == nullptr || tool->direct) return {};
  return fmt::format(
      "it belongs to the tool {}; call {}/{}/open or {}/{}/close, or set 'direct: true' for the tool",
      tool->name, map.name, tool->name, map.name, tool->name);
}

std::unique_ptr<Follower> DeviceMotion::start(Node& node, const Map& map, const ValueTable& values,
                                              SubscriberCounts& subscribers, Calls calls) {
  std::unique_ptr<DeviceMotion> motion(new DeviceMotion(node, map, values, subscribers, std::move(calls)));
  motion->joints_due_.start(now());
  motion->thread_.start();
  motion->thread_.wake();  // the states are shown
  return motion;
}

DeviceMotion::DeviceMotion(Node& node, const Map& map, const ValueTable& values,
                           SubscriberCounts& subscribers, Calls calls)
    : node_(node),
      map_(map),
      thread_([this](Time now) { return step(now); }),
      tools_(map_, values, now(),
             {std::move(calls.write), std::move(calls.ask), [this] { thread_.wake(); },
              [this](std::size_t tool, const ToolStatus& status) { show(tool, status); }}),
      joints_(map_, values, tools_),
      trajectories_(map_, joints_, tools_, window_of(map_),
                    {std::move(calls.schedule), std::move(calls.cancel), [this] { thread_.wake(); }}),
      joint_states_(node, map_, joints_),
      joints_due_(period_of(map_.joint_rate)),
      tool_actions_(node, map_, tools_),
      trajectory_action_(node, map_, joints_, trajectories_) {
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (tools_.has(i) || joints_.driven_by(i)) subscribers.add(i);  // so that it is read
  for (const Tool& tool : map_.tools) {
    const std::string state = fmt::format("{}/state", tool.name);
    publish_.push_back(find(map_, state) == nullptr
                           ? node.advertise_tool_state(fmt::format("{}/{}", map_.name, state))
                           : Node::PublishToolState());
  }
}

void DeviceMotion::begin() {
  for (std::size_t i = 0; i < map_.tools.size(); ++i) {
    services_.push_back(node_.make_service_thread(2));
    offer(i, *services_.back(), ToolEnd::open);
    offer(i, *services_.back(), ToolEnd::closed);
    services_.back()->start();
  }
  tool_actions_.offer();
  trajectory_action_.offer();
  if (!map_.axes.empty() && !map_.service.watchdog.present() && !map_.coupler_watchdog.present())
    node_.log(Level::info,
              fmt::format("{}: its map has no watchdog, so the outputs of its axes stay as they are when the "
                          "connection is lost; if they should go off, set 'watchdog' in the map",
                          map_.name));
}

Time DeviceMotion::step(Time now) {
  Time next = tools_.step(now);
  next = std::min(next, trajectories_.step(now));
  if (now >= joints_due_.due()) {
    joint_states_.publish(now);
    tool_actions_.feed_back(now);
    trajectory_action_.feed_back(now);
    joints_due_.advance(now);
  }
  return std::min(next, joints_due_.due());
}

void DeviceMotion::offer(std::size_t tool, ServiceThread& service, ToolEnd end) {
  service.offer_trigger(
      fmt::format("{}/{}/{}", map_.name, map_.tools[tool].name, end == ToolEnd::open ? "open" : "close"),
      [this, tool, end] { return answer(tool, end); });
}

DeviceMotion::~DeviceMotion() { DeviceMotion::end(); }

void DeviceMotion::write_comes(std::uint32_t point) {
  if (!tools_.has(point) && !joints_.driven_by(point)) return;
  const std::string why = fmt::format("{} was written directly", map_.points[point].name);
  if (tools_.has(point)) tools_.disturb(point, why, now());
  trajectories_.disturb(point, why);
}

void DeviceMotion::on_online(bool online) {
  tools_.on_online(online, now());
  trajectories_.on_online(online);
}

/// One that no trajectory has made is a write by somebody else.
void DeviceMotion::on_scheduled(const ScheduledOutcome& outcome) {
  if (!trajectories_.on_scheduled(outcome) && outcome.result == ScheduledOutcome::Result::done)
    write_comes(outcome.point);
}

void DeviceMotion::safe_comes() {
  const std::string why = "safe values were requested";
  trajectories_.disturb_all(why);
  tools_.disturb_all(why, now());
}

void DeviceMotion::end_comes() {
  for (const auto& service : services_) service->stop();
  trajectories_.end("the driver ends");
  tools_.end("the driver ends", now());
}

void DeviceMotion::end() {
  end_comes();
  thread_.end();  // what has ended by then has its result
  services_.clear();
}

CallAnswer DeviceMotion::answer(std::size_t tool, ToolEnd end) {
  const auto ended = std::make_shared<std::promise<CallAnswer>>();
  tools_.begin(tool, end, now(), [ended](const ToolResult& result) {
    ended->set_value({result.is_success(), result.text});
  });
  return ended->get_future().get();
}

/// Publishes the position before the goal's result, so that the client finds it when the result arrives.
void DeviceMotion::show(std::size_t tool, const ToolStatus& status) {
  if (publish_[tool]) publish_[tool](status, measured_wall_time().of(status.since));
  joint_states_.publish(now());
}

}  // namespace coupler::host
