// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectories.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/core/wall_time.hpp"

namespace coupler::host {
namespace {

using How = TrajectoryResult::How;

/// Goals that have been replaced go on until the newer one begins.
constexpr std::size_t most_running = 8;
constexpr std::chrono::hours most_ahead(1);

/// Returns why a trajectory cannot begin at its start, and what can; empty if it can.
std::string why_impossible(const TrajectoryPlan& plan, Time start, Time now) {
  const auto in_seconds = [](Duration duration) { return std::chrono::duration<double>(duration).count(); };
  if (start > now + most_ahead)
    return fmt::format("it begins in {:.0f} s, and an hour (3600 s) is the most; send it later",
                       in_seconds(start - now));
  if (plan.changes.empty() || start == now || start + plan.changes.front().at >= now) return {};
  return fmt::format(
      "its first change is {:.3f} s in the past; send a later header.stamp, or 0 to begin at once",
      in_seconds(now - start - plan.changes.front().at));
}

}  // namespace

Trajectories::Trajectories(const Map& map, const Joints& joints, Tools& tools, Window window, Calls calls)
    : map_(map), joints_(joints), tools_(tools), window_(window), calls_(std::move(calls)) {}

void Trajectories::begin(GoalKey key, TrajectoryGoal goal, Time received, const Done& done) {
  const bool is_stamped = goal.start != std::chrono::nanoseconds::zero();
  const WallTime wall = measured_wall_time();
  const Time start = is_stamped ? wall.at(goal.start) : received;
  const std::chrono::nanoseconds wall_start = is_stamped ? goal.start : wall.of(received);
  auto plan = plan_trajectory(std::move(goal), joints_);
  TrajectoryError error{TrajectoryCode::successful, {}};
  if (!plan)
    error = plan.error();
  else if (const std::string why = why_impossible(*plan, start, received); !why.empty())
    error = {TrajectoryCode::old_header_timestamp, why};
  bool has_ended = false;
  {
    const std::scoped_lock lock(driving_, mutex_);
    has_ended = !end_reason_.empty();
    if (has_ended)
      error = {TrajectoryCode::path_tolerance_violated, end_reason_};
    else if (error.text.empty() && !is_online_)
      error = {TrajectoryCode::path_tolerance_violated,
               "the device is offline; send the goal again when it is back"};
    else if (error.text.empty() && running_.size() >= most_running)
      error = {TrajectoryCode::invalid_goal,
               fmt::format("{} trajectories are not over yet; send it later", most_running)};
    if (error.text.empty()) {
      for (Running& before : running_) before.motion.end(How::replaced, "a newer goal replaces it", start);
      running_.push_back(
          {++last_id_, key, done, wall_start, {std::move(*plan), joints_, start, received, window_}});
    } else if (!has_ended) {
      refused_.emplace_back(done, TrajectoryResult{How::aborted, error.code, "refused: " + error.text});
    }
  }
  if (has_ended) return done({How::aborted, error.code, error.text});
  calls_.wake();
}

template <class Change>
void Trajectories::each(Change change) {
  {
    const std::scoped_lock lock(driving_, mutex_);
    for (Running& running : running_) change(running);
  }
  calls_.wake();
}

void Trajectories::cancel(GoalKey key) {
  each([key](Running& running) {
    if (running.key.sender == key.sender && running.key.number == key.number)
      running.motion.end(How::cancelled, "cancelled");
  });
}

void Trajectories::disturb(std::uint32_t point, const std::string& why) {
  const auto joint = joints_.driven_by(point);
  if (!joint) return;
  each([&](Running& running) {
    if (running.motion.has(*joint)) running.motion.end(How::aborted, why);
  });
}

/// A goal that was stopped has replaced others, which do nothing more then, either.
void Trajectories::end_replaced() {
  bool is_stopped = false;
  for (auto running = running_.rbegin(); running != running_.rend(); ++running) {
    TrajectoryMotion& motion = running->motion;
    if (is_stopped && motion.is_replaced()) motion.end(How::replaced, "a newer goal replaces it");
    is_stopped |= motion.is_ending() && !motion.is_replaced();
  }
}

void Trajectories::disturb_all(const std::string& why) {
  each([&](Running& running) { running.motion.end(How::aborted, why); });
}

void Trajectories::end(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    end_reason_ = why;
  }
  disturb_all(why);
}

std::optional<Trajectories::Progress> Trajectories::progress(Time now) {
  const std::lock_guard lock(mutex_);
  if (running_.empty() || running_.back().motion.is_ending()) return std::nullopt;
  const Running& running = running_.back();
  const TrajectoryPlan& plan = running.motion.plan();
  Progress progress{running.key, plan.joints, {}, now - running.motion.start()};
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    progress.desired.push_back(plan.position_at(i, progress.from_start));
  return progress;
}

Time Trajectories::step(Time now) {
  const auto positions = [this, now](std::size_t joint) { return joints_.position(joint, now); };
  Work work;
  Time next = Time::max();
  {
    const std::lock_guard driving(driving_);
    {
      const std::lock_guard lock(mutex_);
      for (Running& running : running_) next = std::min(next, running.motion.step(now, positions));
      end_replaced();
      for (Running& running : running_) {
        if (const auto withdrawal = running.motion.take_withdrawal())
          work.withdrawals.emplace_back(&running, *withdrawal);
        while (const auto change = running.motion.take_change(now))
          work.changes.emplace_back(&running, *change);
      }
    }
    for (const auto& [running, what] : work.withdrawals) withdraw(*running, what);
    for (const auto& [running, change] : work.changes) carry_out(*running, change);
  }
  {
    const std::lock_guard lock(mutex_);
    work.results.swap(refused_);
    for (auto each = running_.begin(); each != running_.end();) {
      const auto running = each++;
      const auto result = running->motion.take_result();
      if (!result) continue;
      work.results.emplace_back(std::move(running->done), *result);
      running_.erase(running);
    }
  }
  for (const auto& [done, result] : work.results) done(result);
  return next;
}

/// The key of the goal that a trajectory gives to a tool.
GoalKey Trajectories::tool_key(const Running& running, std::size_t joint) const {
  return {this, running.id * joints_.size() + joint};
}

/// Tells a trajectory what has happened, unless it has its result.
template <class Change>
void Trajectories::tell(std::uint64_t id, Change change) {
  {
    const std::lock_guard lock(mutex_);
    for (Running& running : running_)
      if (running.id == id) change(running.motion);
  }
  calls_.wake();
}

void Trajectories::carry_out(Running& running, std::size_t change) {
  const JointChange& what = running.motion.plan().changes[change];
  const Joints::Joint& joint = joints_[what.joint];
  if (joint.tool != nullptr)
    return tools_.begin(
        joint.index, what.end, running.motion.due(change),
        [this, id = running.id, change](const ToolResult& result) {
          tell(id, [&](TrajectoryMotion& motion) { motion.on_tool(change, result); });
        },
        tool_key(running, what.joint));
  ScheduledWrite write;
  write.write = make_write(map_, joint.point_index, {what.value.data(), range(*joint.point).count()});
  write.due = running.motion.due(change);
  write.asked = running.wall_start + what.at;
  write.may_be_late = running.motion.may_be_late(change);
  write.owner = running.id;
  calls_.schedule(write, [this, id = running.id, change](const ScheduleAnswer& answer) {
    tell(id, [&](TrajectoryMotion& motion) { motion.on_answer(change, answer); });
  });
}

void Trajectories::withdraw(Running& running, const TrajectoryMotion::Withdrawal& what) {
  const Time now = std::chrono::steady_clock::now();
  WritesFrom writes{{}, what.from, running.id};
  for (const std::size_t joint : running.motion.plan().joints) {
    const std::size_t index = joints_[joint].index;
    if (joints_[joint].axis != nullptr)
      writes.points.push_back(joints_[joint].point_index);
    else if (what.how == How::cancelled)
      tools_.cancel(index, tool_key(running, joint), now);
    else if (what.how == How::aborted)
      tools_.abort(index, tool_key(running, joint), what.why, now);
  }
  const auto withdrawn = [this, id = running.id](const CallAnswer& /*answer*/) {
    tell(id, [](TrajectoryMotion& motion) { motion.on_withdrawn(); });
  };
  if (writes.points.empty()) return withdrawn({});
  calls_.cancel(std::move(writes), withdrawn);
}

bool Trajectories::on_scheduled(const ScheduledOutcome& outcome) {
  bool is_ours = false;
  {
    const std::lock_guard lock(mutex_);
    for (Running& running : running_) is_ours |= running.motion.on_outcome(outcome);
  }
  if (is_ours) calls_.wake();
  return is_ours;
}

void Trajectories::on_online(bool online) {
  {
    const std::scoped_lock lock(driving_, mutex_);
    is_online_ = online;
    if (online) return;
    for (Running& running : running_) running.motion.end(How::aborted, "the device went offline");
  }
  calls_.wake();
}

}  // namespace coupler::host
