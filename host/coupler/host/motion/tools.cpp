// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/tools.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "coupler/map/lookup_by_name.hpp"

namespace coupler::host {
namespace {

constexpr std::array<ToolPart, tool_parts> all_parts{ToolPart::close, ToolPart::open, ToolPart::closed,
                                                     ToolPart::opened, ToolPart::holds};

}  // namespace

Tools::Tools(const Map& map, const ValueTable& values, Time now, Calls calls)
    : map_(map), values_(values), calls_(std::move(calls)), places_(map.points.size()) {
  LookupByName points(map_.points, [](const Point& point) { return point.name; });
  for (std::size_t i = 0; i < map_.tools.size(); ++i) {
    Running& running = running_.emplace_back(map_.tools[i], now);
    for (const ToolPart part : all_parts) {
      const Point* point = points.find(point_of(map_.tools[i], part));
      if (point == nullptr) continue;  // it does not have that part; the loader has checked the others
      const auto index = static_cast<std::uint32_t>(point - map_.points.data());
      running.points[static_cast<std::size_t>(part)] = index;
      places_[index].push_back({i, part});
    }
  }
}

void Tools::begin(std::size_t tool, ToolEnd end, Time now, const Done& done, GoalKey key) {
  std::string ended;
  {
    const std::lock_guard lock(mutex_);
    ended = end_reason_;
    if (ended.empty()) {
      running_[tool].goals.push_back({key, done});
      running_[tool].motion.begin(end, now);
    }
  }
  if (!ended.empty()) return done({ToolResult::How::aborted, ended});
  calls_.wake();
}

/// Calls change(motion) if the goal has no result yet.
template <class Change>
void Tools::change_goal(std::size_t tool, GoalKey key, Change change) {
  {
    const std::scoped_lock lock(writing_, mutex_);
    Running& running = running_[tool];
    if (running.goals.empty()) return;
    // The others have ended: they wait for step() to give their results.
    const GoalKey& last = running.goals.back().key;
    if (last.sender != key.sender || last.number != key.number) return;
    change(running.motion);
  }
  calls_.wake();
}

void Tools::cancel(std::size_t tool, GoalKey key, Time now) {
  change_goal(tool, key, [now](ToolMotion& motion) { motion.cancel(now); });
}

void Tools::abort(std::size_t tool, GoalKey key, const std::string& why, Time now) {
  change_goal(tool, key, [&](ToolMotion& motion) { motion.disturb(why, now); });
}

std::optional<JointPosition> Tools::position(std::size_t tool, Time now) {
  const std::lock_guard lock(mutex_);
  return position_of(tool, now);
}

std::optional<JointPosition> Tools::position_of(std::size_t tool, Time now) const {
  const Running& running = running_[tool];
  const std::optional<double> position = running.motion.position();
  if (!position || !is_online_) return std::nullopt;
  std::optional<Time> at;
  for (const ToolPart input : tool_inputs) {
    if (point_of(map_.tools[tool], input).empty()) continue;
    const auto known = known_at(running, input, now);
    if (!known) return std::nullopt;
    at = std::min(*known, at.value_or(*known));
  }
  if (!at)  // no inputs: the device still has the outputs as the tool has set them
    for (const ToolPart output : {ToolPart::close, ToolPart::open})
      if (!point_of(map_.tools[tool], output).empty())
        if (const auto known = known_at(running, output, now)) at = std::min(*known, at.value_or(*known));
  return JointPosition{*position, std::max(at.value_or(now), running.motion.there_since())};
}

/// Returns the latest time at which the part is known to have had the value that the motion has seen, or
/// nothing if it has no good value. The table may already hold a newer value.
std::optional<Time> Tools::known_at(const Running& running, ToolPart part, Time now) const {
  const ValueTable::Freshness fresh = values_.freshness(running.point(part), now);
  if (fresh.state != PointQuality::State::good || !fresh.last_good || !running.motion.knows(part))
    return std::nullopt;
  const Seen& seen = running.seen[static_cast<std::size_t>(part)];
  return fresh.number == seen.number ? *fresh.last_good : seen.at;
}

void Tools::disturb(std::uint32_t point, const std::string& why, Time now) {
  {
    const std::scoped_lock lock(writing_, mutex_);
    for (const Place& place : places_[point])
      if (is_output(place.part)) running_[place.tool].motion.disturb(why, now);
  }
  calls_.wake();
}

void Tools::disturb_all(const std::string& why, Time now) {
  {
    const std::scoped_lock lock(writing_, mutex_);
    for (Running& running : running_) running.motion.disturb(why, now);
  }
  calls_.wake();
}

void Tools::end(const std::string& why, Time now) {
  {
    const std::lock_guard lock(mutex_);
    end_reason_ = why;
  }
  disturb_all(why, now);
}

Time Tools::step(Time now) {
  Work work;
  Time next = Time::max();
  {
    const std::lock_guard writing(writing_);
    {
      const std::lock_guard lock(mutex_);
      take_results();
      for (std::size_t i = 0; i < running_.size(); ++i) {
        next = std::min(next, running_[i].motion.step(now));
        take(i, now, work);
      }
    }
    for (const Write& write : work.writes) calls_.write(write);
  }
  for (const std::uint32_t point : work.asked) calls_.ask(point);
  for (const auto& [tool, status] : work.shown) calls_.show(tool, status);
  for (const auto& [done, result] : work.results) done(result);
  return next;
}

/// Tells the tools what became of their writes.
void Tools::take_results() {
  for (auto each = sent_.begin(); each != sent_.end();) {
    const auto sent = each++;
    if (!sent->failure) continue;
    running_[sent->tool].motion.on_written(sent->number, *sent->failure, sent->at);
    sent_.erase(sent);
  }
}

void Tools::take(std::size_t tool, Time now, Work& work) {
  Running& running = running_[tool];
  if (const auto command = running.motion.take_command()) {
    Write write = make_bit_write(map_, running.point(command->output), command->on);
    write.ordered = true;
    write.until = now + map_.tools[tool].timeout;
    write.listener = &sent_.emplace_back(*this, tool, *command);
    work.writes.push_back(write);
  }
  for (const ToolPart input : running.motion.take_asked()) work.asked.push_back(running.point(input));
  if (const auto status = running.motion.take_status()) work.shown.emplace_back(tool, *status);
  for (ToolResult& result : running.motion.take_results()) {
    if (const auto known = position_of(tool, now)) result.position = known->position;
    work.results.emplace_back(std::move(running.goals.front().done), std::move(result));
    running.goals.erase(running.goals.begin());
  }
}

void Tools::on_result(Sent& sent, const WriteResult& result) {
  const std::lock_guard lock(mutex_);
  sent.at = std::chrono::steady_clock::now();
  sent.failure = result.outcome == WriteResult::Outcome::ok ? "" : "not written";
  calls_.wake();
  if (!sent.failure->empty()) sent.failure = to_string(result);  // last: there may be no memory for it
}

/// change(running, part, point) returns whether step() is to be called.
template <class Change>
void Tools::each_place(Span<const std::uint32_t> points, Change change) {
  bool is_news = false;
  {
    const std::lock_guard lock(mutex_);
    for (const std::uint32_t point : points)
      for (const auto& [tool, part] : places_[point]) is_news |= change(running_[tool], part, point);
  }
  if (is_news) calls_.wake();
}

void Tools::on_values(Span<const std::uint32_t> points, Time now) {
  each_place(points, [&](Running& running, ToolPart part, std::uint32_t point) {
    const ValueTable::Freshness fresh = values_.freshness(point, now);
    running.seen[static_cast<std::size_t>(part)] = {fresh.number, fresh.last_good.value_or(now)};
    return running.motion.see(part, values_.registers(point)[0] != 0, values_.stamp(point), now);
  });
}

void Tools::on_no_values(Span<const std::uint32_t> points, Time now) {
  each_place(points, [&](Running& running, ToolPart part, std::uint32_t /*point*/) {
    running.motion.lose(part, now);
    return true;
  });
}

void Tools::on_gap(Time now) {
  {
    const std::lock_guard lock(mutex_);
    for (Running& running : running_)
      for (const ToolPart part : all_parts) running.motion.lose(part, now);
  }
  calls_.wake();
}

void Tools::on_online(bool online, Time now) {
  {
    const std::lock_guard lock(mutex_);
    is_online_ = online;
    if (online) return;
    for (Running& running : running_) running.motion.go_offline(now);
  }
  calls_.wake();
}

}  // namespace coupler::host
