// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_waits.hpp"

#include <chrono>
#include <exception>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/named_write.hpp"

namespace coupler::host {
namespace {

constexpr std::string_view action_name = "wait_for";
constexpr std::chrono::hours longest_wait(24);

GoalEnd end_of(WaitResult::End end) {
  switch (end) {
    case WaitResult::End::met: return GoalEnd::succeeded;
    case WaitResult::End::not_met: return GoalEnd::aborted;
    case WaitResult::End::cancelled: break;
  }
  return GoalEnd::cancelled;
}

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

bool can_wait_for(const Map& map) { return map.wait_for && !is_taken(map, action_name); }

std::unique_ptr<Follower> DeviceWaits::start(Node& node, const Map& map, const ValueTable& values,
                                             SubscriberCounts& subscribers,
                                             std::function<void(std::uint32_t)> ask) {
  return std::unique_ptr<DeviceWaits>(new DeviceWaits(node, map, values, subscribers, std::move(ask)));
}

DeviceWaits::DeviceWaits(Node& node, const Map& map, const ValueTable& values, SubscriberCounts& subscribers,
                         std::function<void(std::uint32_t)> ask)
    : map_(map),
      subscribers_(subscribers),
      thread_([this](Time now) { return waits_.step(now); }),
      waits_(
          map_, values, std::chrono::steady_clock::now(), [this] { thread_.wake(); }, std::move(ask)),
      server_(node.offer_wait_for(fmt::format("{}/{}", map_.name, action_name),
                                  {[this](WaitForServer& server, GoalNumber number, Time received,
                                          const WaitForGoal& goal) { begin(server, number, received, goal); },
                                   [this](WaitForServer&, GoalNumber number) { waits_.cancel(number); }})) {
  thread_.start();
}

DeviceWaits::~DeviceWaits() { DeviceWaits::end(); }

void DeviceWaits::end() {
  end_comes();
  thread_.end();  // what has ended by then has its result
}

/// Returns what a goal asks for, or what is wrong with it and the remedy.
tl::expected<WaitGoal, std::string> DeviceWaits::understood(const WaitForGoal& goal, Time now) const {
  const auto named = read_point_named(map_, goal.point);
  if (!named) return tl::unexpected(named.error());
  const Point& point = **named;
  const auto condition = Condition::parse(point, goal.condition, goal.value);
  if (!condition) return tl::unexpected(condition.error());
  if (goal.timeout <= goal.timeout.zero() || goal.timeout > longest_wait)
    return tl::unexpected(fmt::format("a timeout of {:g} s; send one above 0, and at most a day (86400 s)",
                                      seconds(goal.timeout)));
  if (goal.for_at_least < goal.for_at_least.zero() || goal.for_at_least > goal.timeout)
    return tl::unexpected(fmt::format("for_at_least is {:g} s; send 0 to {:g} s, the timeout",
                                      seconds(goal.for_at_least), seconds(goal.timeout)));
  Time since = now;
  if (goal.since != goal.since.zero()) {
    const WallTime wall = measured_wall_time();
    since = wall.at(goal.since);
    if (since > now + wall.error())
      return tl::unexpected(fmt::format("'since' is {:g} s ahead; send a time that has passed, or 0 for now",
                                        seconds(since - now)));
  }
  const auto index = static_cast<std::uint32_t>(&point - map_.points.data());
  return WaitGoal{index, *condition, std::chrono::duration_cast<Duration>(goal.for_at_least), since,
                  now + std::chrono::duration_cast<Duration>(goal.timeout)};
}

void DeviceWaits::begin(WaitForServer& server, GoalNumber number, Time received, const WaitForGoal& goal) {
  const auto asked = understood(goal, received);
  if (!asked)
    return server.finish(number, GoalEnd::aborted, {false, {}, {}, {}, asked.error()}, asked.error());
  const std::uint32_t point = asked->point;
  subscribers_.add(point);  // so that it is read
  try {
    waits_.begin(number, *asked, received, [this, &server, number, point](const WaitResult& result) {
      finish(server, number, point, result);
    });
  } catch (const std::exception& error) {  // no memory: the goal ends, and the driver goes on
    return finish(server, number, point, {WaitResult::End::not_met, {}, {}, error.what()});
  }
  if (thread_.has_ended()) waits_.step(received);  // the thread may not see it any more
}

void DeviceWaits::finish(WaitForServer& server, GoalNumber number, std::uint32_t point,
                         const WaitResult& result) {
  subscribers_.remove(point);
  WaitForResult sent{result.end == WaitResult::End::met, result.value, {}, {}, result.reason};
  if (sent.met) {
    const WallTime wall = measured_wall_time();
    sent.stamp = wall.of(result.stamp.at);
    sent.uncertainty = result.stamp.uncertainty + wall.error();
  }
  server.finish(number, end_of(result.end), sent, result.reason);
}

}  // namespace coupler::host
