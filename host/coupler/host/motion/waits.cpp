// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/waits.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/core/value_text.hpp"

namespace coupler::host {
namespace {

using State = PointQuality::State;

WaitResult not_met(std::string reason) { return {WaitResult::End::not_met, {}, {}, std::move(reason)}; }

bool has(Span<const std::uint32_t> points, std::uint32_t point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

}  // namespace

Waits::Waits(const Map& map, const ValueTable& values, Time now, std::function<void()> wake,
             std::function<void(std::uint32_t)> ask)
    : map_(map), values_(values), wake_(std::move(wake)), ask_(std::move(ask)), history_(map, now) {}

void Waits::begin(Number number, const WaitGoal& goal, Time now, Done done) {
  const std::lock_guard lock(mutex_);
  const auto at =
      running_.emplace(number, Running{Wait(goal, map_.points[goal.point]), std::move(done)}).first;
  Wait& wait = at->second.wait;
  if (std::string why = why_impossible(goal, now); !why.empty()) {
    finish(at, not_met(std::move(why)));
  } else {
    replay(wait);
    if (wait.last().empty()) begin_with_last(wait, now);
    ask_(goal.point);
  }
  wake_();
}

/// Why the wait cannot begin; empty if it can.
std::string Waits::why_impossible(const WaitGoal& goal, Time now) const {
  if (!end_reason_.empty()) return end_reason_;
  if (running_.size() > most) return fmt::format("{} goals wait already, and no more can; cancel one", most);
  if (goal.since >= now) return {};
  const std::string_view name = map_.points[goal.point].name;
  if (!history_.keeps(goal.point))
    return fmt::format("earlier values of {} are not kept, because it is long; leave 'since' out", name);
  const State state = values_.quality(goal.point, now).state;
  if (state == State::stale || state == State::never_read || state == State::not_wanted)
    return fmt::format("{} was not read before the goal came; leave 'since' out", name);
  if (!history_.reaches(goal.since))
    return fmt::format(
        "what happened at 'since' is not known: the driver keeps the last {} changes of a device since its "
        "start; send a later time",
        ChangeHistory::most_changes);
  return {};
}

/// The history has what the device's thread has said. The table may have a later value, which is still to
/// come.
void Waits::begin_with_last(Wait& wait, Time now) const {
  const std::uint32_t point = wait.goal().point;
  if (history_.keeps(point)) {
    if (const auto* last = history_.last(point)) wait.begin_with(last);
  } else if (const auto value = values_.get(point, now); value.quality.state == State::good) {
    wait.begin_with(value.registers.data());
  }
}

/// Shows it what has changed since the time that it is interested in.
void Waits::replay(Wait& wait) const {
  history_.each_since(wait.goal().point, wait.goal().since, [&](const ChangeHistory::Change& change) {
    if (change.has_before)
      wait.see(change.before_until, change.before.data());
    else
      wait.interrupt();
    wait.see(change.stamp, change.now.data());
  });
  if (history_.last(wait.goal().point) == nullptr) wait.interrupt();
}

void Waits::cancel(Number number) {
  const std::lock_guard lock(mutex_);
  const auto at = running_.find(number);
  if (at == running_.end()) return;
  finish(at, {WaitResult::End::cancelled, {}, {}, "canceled"});
  wake_();
}

void Waits::end(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  end_reason_ = reason;
  while (!running_.empty()) finish(running_.begin(), not_met(reason));
  wake_();
}

void Waits::finish(Waiting::iterator at, WaitResult result) {
  const Wait& wait = at->second.wait;
  if (!wait.last().empty()) result.value = format_value(wait.last().data(), map_.points[wait.goal().point]);
  ended_.emplace_back(std::move(at->second.done), std::move(result));
  running_.erase(at);
}

/// Why the point's value is not to be waited for; empty if it is. A point that nobody has read before may
/// still have the state from then.
std::string Waits::why_not(const Running& running, Time now) const {
  const std::uint32_t index = running.wait.goal().point;
  const std::string_view name = map_.points[index].name;
  const PointQuality quality = values_.quality(index, now);
  switch (quality.state) {
    case State::good:
    case State::never_read:
    case State::not_wanted: return {};
    case State::stale: return running.wait.has_seen() ? fmt::format("{} has not been read lately", name) : "";
    case State::offline: return fmt::format("the device of {} is offline", name);
    case State::rejected: break;
    case State::exception:
    case State::invalid:
    case State::fault:
      if (!running.had_no_value) return {};
  }
  const std::string why = !quality.why.empty()   ? ": " + quality.why
                          : quality.is_refused() ? fmt::format(": exception {:02X}", quality.refused_with())
                                                 : std::string();
  return fmt::format("{} has no value, it is {}{}", name, to_string(quality.state), why);
}

/// Returns when to look at it again.
Time Waits::look(Waiting::iterator at, Time now) {
  Running& running = at->second;
  const Wait& wait = running.wait;
  const WaitGoal& goal = wait.goal();
  if (wait.is_met()) {
    finish(at, {WaitResult::End::met, {}, *wait.since(), {}});
    return Time::max();
  }
  if (std::string why = why_not(running, now); !why.empty()) {
    finish(at, not_met(std::move(why)));
    return Time::max();
  }
  const Point& point = map_.points[goal.point];
  if (now >= goal.deadline) {
    finish(at, not_met(!wait.has_seen()
                           ? fmt::format("timed out before {} was read", point.name)
                           : fmt::format(
                                 "timed out; {} is {}", point.name,
                                 wait.last().empty() ? "unknown" : format_value(wait.last().data(), point))));
    return Time::max();
  }
  if (wait.due() <= now && !std::exchange(running.asked, true)) ask_(goal.point);
  if (wait.due() > now) running.asked = false;
  const Time due = running.asked ? Time::max() : wait.due();
  const Time stale_from = values_.quality(goal.point, now).stale_from;
  return std::min({goal.deadline, due, stale_from == Time::max() ? stale_from : stale_from + Duration(1)});
}

Time Waits::step(Time now) {
  std::vector<std::pair<Done, WaitResult>> ended;
  Time next = Time::max();
  {
    const std::lock_guard lock(mutex_);
    for (auto each = running_.begin(); each != running_.end();) {
      const auto at = each++;
      next = std::min(next, look(at, now));
    }
    ended.swap(ended_);
  }
  for (const auto& [done, result] : ended) done(result);
  return next;
}

void Waits::on_values(Span<const std::uint32_t> points, bool are_told) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points)
    history_.see(point, values_.stamp(point), values_.registers(point), are_told);
  bool has_news = false;
  for (auto& [number, running] : running_) {
    Wait& wait = running.wait;
    const std::uint32_t point = wait.goal().point;
    if (!has(points, point)) continue;
    const bool is_first = !wait.has_seen();  // from now on it may become stale
    const Time due = wait.due();
    wait.see(values_.stamp(point), values_.registers(point));
    has_news |= is_first || wait.is_met() || wait.due() != due;
  }
  if (has_news) wake_();
}

/// Ends those whose point is not known any more. The others may go on, but not with what has held until now.
void Waits::look_again(const std::function<bool(std::uint32_t point)>& is_one, Time now) {
  if (running_.empty()) return;
  for (auto each = running_.begin(); each != running_.end();) {
    const auto at = each++;
    if (!is_one(at->second.wait.goal().point)) continue;
    at->second.wait.interrupt();
    at->second.had_no_value = true;
    look(at, now);
  }
  wake_();
}

void Waits::on_no_values(Span<const std::uint32_t> points, Time at) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) history_.lose(point);
  look_again([&](std::uint32_t point) { return has(points, point); }, at);
}

void Waits::on_gap() {
  const std::lock_guard lock(mutex_);
  history_.lose_all();
  for (auto& [number, running] : running_) running.wait.interrupt();
}

void Waits::on_online(bool online, Time at) {
  if (online) return;
  const std::lock_guard lock(mutex_);
  history_.lose_all();
  look_again([](std::uint32_t) { return true; }, at);
}

void Waits::on_wanted(std::uint32_t point) {
  const std::lock_guard lock(mutex_);
  history_.lose(point);
}

}  // namespace coupler::host
