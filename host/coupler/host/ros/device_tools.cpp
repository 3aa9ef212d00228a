// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_tools.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/wall_time.hpp"

namespace coupler::host {

std::string why_not_direct(const Map& map, const Point& point) {
  const Tool* tool = tool_with_output(map, point.name);
  if (tool == nullptr || tool->direct) return {};
  return fmt::format(
      "it belongs to the tool {}; call {}/{}/open or {}/{}/close, or set 'direct: true' for the tool",
      tool->name, map.name, tool->name, map.name, tool->name);
}

std::unique_ptr<Follower> DeviceTools::start(Node& node, const Map& map, const ValueTable& values,
                                             SubscriberCounts& subscribers,
                                             std::function<void(const Write&)> write,
                                             std::function<void(std::uint32_t)> ask) {
  std::unique_ptr<DeviceTools> tools(
      new DeviceTools(node, map, values, subscribers, std::move(write), std::move(ask)));
  tools->joints_due_.start(now());
  tools->thread_.start();
  tools->thread_.wake();  // the states are shown
  return tools;
}

DeviceTools::DeviceTools(Node& node, const Map& map, const ValueTable& values, SubscriberCounts& subscribers,
                         std::function<void(const Write&)> write, std::function<void(std::uint32_t)> ask)
    : node_(node),
      map_(map),
      thread_([this](Time now) { return step(now); }),
      tools_(map_, values, now(),
             {std::move(write), std::move(ask), [this] { thread_.wake(); },
              [this](std::size_t tool, const ToolStatus& status) { show(tool, status); }}),
      joints_(node, map_, tools_),
      joints_due_(period_of(map_.joint_rate)),
      actions_(node, map_, tools_) {
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (tools_.has(i)) subscribers.add(i);  // so that it is read
  for (const Tool& tool : map_.tools) {
    const std::string state = fmt::format("{}/state", tool.name);
    publish_.push_back(find(map_, state) == nullptr
                           ? node.advertise_tool_state(fmt::format("{}/{}", map_.name, state))
                           : Node::PublishToolState());
  }
}

void DeviceTools::begin() {
  for (std::size_t i = 0; i < map_.tools.size(); ++i) {
    services_.push_back(node_.make_service_thread(2));
    offer(i, *services_.back(), ToolEnd::open);
    offer(i, *services_.back(), ToolEnd::closed);
    services_.back()->start();
  }
  actions_.offer();
}

Time DeviceTools::step(Time now) {
  const Time next = tools_.step(now);
  if (now >= joints_due_.due()) {
    joints_.publish(now);
    actions_.feed_back(now);
    joints_due_.advance(now);
  }
  return std::min(next, joints_due_.due());
}

void DeviceTools::offer(std::size_t tool, ServiceThread& service, ToolEnd end) {
  service.offer_trigger(
      fmt::format("{}/{}/{}", map_.name, map_.tools[tool].name, end == ToolEnd::open ? "open" : "close"),
      [this, tool, end] { return answer(tool, end); });
}

DeviceTools::~DeviceTools() { DeviceTools::end(); }

void DeviceTools::write_comes(std::uint32_t point) {
  if (tools_.has(point))
    tools_.disturb(point, fmt::format("{} was written directly", map_.points[point].name), now());
}

void DeviceTools::safe_comes() { tools_.disturb_all("safe values were requested", now()); }

void DeviceTools::end_comes() {
  for (const auto& service : services_) service->stop();
  tools_.end("the driver ends", now());
}

void DeviceTools::end() {
  end_comes();
  thread_.end();  // what has ended by then has its result
  services_.clear();
}

CallAnswer DeviceTools::answer(std::size_t tool, ToolEnd end) {
  const auto ended = std::make_shared<std::promise<CallAnswer>>();
  tools_.begin(tool, end, now(), [ended](const ToolResult& result) {
    ended->set_value({result.is_success(), result.text});
  });
  return ended->get_future().get();
}

/// Publishes the position before the goal's result, so that the client finds it when the result arrives.
void DeviceTools::show(std::size_t tool, const ToolStatus& status) {
  if (publish_[tool]) publish_[tool](status, measured_wall_time().of(status.since));
  joints_.publish(now());
}

}  // namespace coupler::host
