// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectory_motion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using Result = ScheduledOutcome::Result;

/// How often it is tried again whether there is room for a change, and whether an axis is in its tolerance.
constexpr std::chrono::milliseconds retry(20);
/// How late a change may be made: requests of others may be in front of it.
constexpr std::chrono::milliseconds late(250);
/// A change that is due soon after the goal has come is on its way then, and may be later.
constexpr std::chrono::milliseconds soon(100);
constexpr std::chrono::seconds late_at_first(1);

double in_ms(Duration duration) { return std::chrono::duration<double, std::milli>(duration).count(); }

}  // namespace

TrajectoryMotion::TrajectoryMotion(TrajectoryPlan plan, const Joints& joints, Time start, Time now,
                                   Window window)
    : plan_(std::move(plan)),
      joints_(joints),
      start_(start),
      received_(now),
      window_(window),
      changes_(plan_.changes.size()),
      most_(window.most),
      held_(joints.size()) {}

bool TrajectoryMotion::has(std::size_t joint) const {
  return std::find(plan_.joints.begin(), plan_.joints.end(), joint) != plan_.joints.end();
}

/// A later change of the joint may have found the room that this one lacked.
Duration TrajectoryMotion::may_be_late(std::size_t change) const {
  if (changes_[change].lacked_room) return Duration::zero();
  return due(change) <= received_ + soon ? Duration(late_at_first) : Duration(late);
}

/// "glue to 1 at 0.500 s"
std::string TrajectoryMotion::describe(std::size_t change) const {
  const JointChange& what = plan_.changes[change];
  return fmt::format("{} to {:g} at {:.3f} s", joints_[what.joint].name, what.position,
                     std::chrono::duration<double>(what.at).count());
}

/// A change of a tool begins a goal of the tool, which has no time.
Time TrajectoryMotion::hand_over_at(std::size_t change) const {
  return is_tool(change) ? due(change) : due(change) - window_.horizon;
}

std::optional<std::size_t> TrajectoryMotion::take_change(Time now) {
  while (next_ < changes_.size() && changes_[next_].state != State::waiting) ++next_;
  for (std::size_t i = next_; i < changes_.size() && due(i) <= now + window_.horizon; ++i) {
    if (changes_[i].state != State::waiting || hand_over_at(i) > now) continue;
    if (!is_tool(i)) {
      if (room_at_ || has_to_wait(i)) continue;
      ++axes_under_way_;
      ++unanswered_;
      if (due(i) <= now) hold(i);
    }
    changes_[i].state = State::given;
    return i;
  }
  return std::nullopt;
}

/// Returns whether a change of an axis waits for the outcome of another one.
bool TrajectoryMotion::has_to_wait(std::size_t change) const {
  return axes_under_way_ >= most_ || held_[joint(change)] > 0;
}

void TrajectoryMotion::hold(std::size_t change) {
  if (!std::exchange(changes_[change].holds, true)) ++held_[joint(change)];
}

void TrajectoryMotion::on_answer(std::size_t change, const ScheduleAnswer& answer) {
  --unanswered_;
  Change& which = changes_[change];
  if (answer.number != 0) {
    which.state = State::accepted;
    which.number = answer.number;
    accepted_.push_back(change);
    if (!answer.by_device) hold(change);
    const auto early = std::find_if(early_.begin(), early_.end(), [&](const ScheduledOutcome& outcome) {
      return outcome.number == answer.number;
    });
    if (early != early_.end()) settle(change, *early);
  } else {
    over(change);
    if (answer.is_full && due(change) < ends_) {
      which = {State::waiting, 0, true, false};
      --over_;
      next_ = std::min(next_, change);
      first_open_ = std::min(first_open_, change);
      most_ = std::max<std::size_t>(1, axes_under_way_);  // it is known now how many places there are
      room_at_ = Time::min();
    } else {
      fail(change, answer.text);
    }
  }
  if (unanswered_ == 0) early_.clear();
}

bool TrajectoryMotion::on_outcome(const ScheduledOutcome& outcome) {
  const auto found = std::find_if(accepted_.begin(), accepted_.end(), [&](std::size_t change) {
    return changes_[change].number == outcome.number;
  });
  if (found != accepted_.end()) {
    settle(*found, outcome);
    return true;
  }
  if (unanswered_ > 0) early_.push_back(outcome);
  return false;
}

void TrajectoryMotion::settle(std::size_t change, const ScheduledOutcome& outcome) {
  over(change);
  room_at_.reset();
  if (outcome.result != Result::done) return fail(change, outcome.reason);
  most_ = std::min(most_ + 1, window_.most);
  ++made_;
  made_at_ = std::max(made_at_, outcome.at.at);
  if (outcome.lateness() <= latest_) return;
  latest_ = outcome.lateness();
  latest_error_ = outcome.at.uncertainty;
}

void TrajectoryMotion::on_tool(std::size_t change, const ToolResult& result) {
  if (changes_[change].state != State::given) return;
  over(change);
  const bool is_made =
      result.is_success() || (result.how == ToolResult::How::replaced && is_followed(change));
  if (!is_made) return fail(change, result.text);
  ++made_;
}

/// Returns whether a later change of the same tool has been handed over, which replaces this one.
bool TrajectoryMotion::is_followed(std::size_t change) const {
  for (std::size_t i = change + 1; i < changes_.size(); ++i)
    if (joint(i) == joint(change) && changes_[i].state != State::waiting) return true;
  return false;
}

void TrajectoryMotion::over(std::size_t change) {
  Change& which = changes_[change];
  if (!is_tool(change) && which.state != State::waiting) --axes_under_way_;
  accepted_.erase(std::remove(accepted_.begin(), accepted_.end(), change), accepted_.end());
  if (which.holds) --held_[joint(change)];
  which.holds = false;
  which.state = State::over;
  ++over_;
  while (first_open_ < changes_.size() && changes_[first_open_].state == State::over) ++first_open_;
}

/// One that was to be taken back has not failed.
void TrajectoryMotion::fail(std::size_t change, const std::string& why) {
  if (due(change) < ends_) end(How::aborted, fmt::format("{}: {}", describe(change), why));
}

void TrajectoryMotion::end(How how, const std::string& why, Time from, TrajectoryCode code) {
  if (ending_ && (!is_replaced() || from >= ends_)) return;
  if (how == How::replaced && from > last_due()) return;
  if (!ending_ || how != How::replaced) {
    if (how == How::done || how == How::cancelled) code = TrajectoryCode::successful;
    if (how == How::replaced) code = TrajectoryCode::invalid_goal;  // as JointTrajectoryController says it
    ending_ = {how, code, why};
  }
  ends_ = from;
  bool is_left = false;
  for (std::size_t i = first_open_; i < changes_.size(); ++i) {
    const State state = changes_[i].state;
    if (state == State::over) continue;
    if ((state == State::waiting && due(i) >= from) || (state == State::given && is_tool(i) && is_replaced()))
      over(i);
    else
      is_left |= due(i) >= from;
  }
  if (!is_left) return;
  if (!withdrawal_) ++withdrawals_;
  withdrawal_ = Withdrawal{from, ending_->how, why};
}

std::optional<TrajectoryResult> TrajectoryMotion::take_result() {
  if (!ending_ || is_taken_ || withdrawals_ > 0 || over_ < changes_.size()) return std::nullopt;
  is_taken_ = true;
  if (ending_->how != How::done)
    ending_->text += fmt::format("; {} of {} changes had been made", made_, changes_.size());
  return ending_;
}

Time TrajectoryMotion::step(Time now, const Positions& positions) {
  if (over_ == changes_.size()) return ending_ ? Time::max() : arrive(now, positions);
  const Time room_at = await_room(now);
  Time next = Time::max();
  for (std::size_t i = next_; i < changes_.size(); ++i) {
    if (changes_[i].state != State::waiting) continue;
    if (!is_tool(i) && due(i) + may_be_late(i) <= now) {
      over(i);
      fail(i, changes_[i].lacked_room
                  ? "the device had no free place for it in time; schedule fewer writes at this device"
                  : "it could not be made in time; the connection is too slow for changes so close together");
      return now;  // what is left is decided anew
    }
    if (is_tool(i))
      next = std::min(next, hand_over_at(i));
    else if (has_to_wait(i))  // an outcome is told
      next = std::min(next, due(i) + may_be_late(i));
    else
      next = std::min(next, std::max(hand_over_at(i), room_at));
    if (due(i) > now + window_.horizon) break;
  }
  return next;
}

/// Returns when it is tried again whether the device has a place. Others may have all of them: nothing tells
/// when one is free.
Time TrajectoryMotion::await_room(Time now) {
  if (room_at_ == Time::min()) room_at_ = now + retry;
  if (room_at_ && now >= *room_at_) room_at_.reset();
  return room_at_.value_or(Time::min());
}

/// All changes are made.
Time TrajectoryMotion::arrive(Time now, const Positions& positions) {
  if (now < last_due()) return last_due();
  if (const std::string why = why_intolerable(positions); !why.empty()) {
    if (now < last_due() + plan_.time_tolerance) return now + retry;
    end(How::aborted, why, Time::min(), TrajectoryCode::goal_tolerance_violated);
    return Time::max();
  }
  std::string text = made_ == 1 ? std::string("1 change") : fmt::format("{} changes", made_);
  if (latest_ != Duration::min())
    text += fmt::format(", at most {:.3f} ms late (± {:.3f})", in_ms(std::max(latest_, Duration::zero())),
                        in_ms(latest_error_));
  end(How::done, text);
  return Time::max();
}

/// Only a position from after the last change counts.
std::string TrajectoryMotion::why_intolerable(const Positions& positions) const {
  for (const auto& [joint, last, most] : plan_.tolerances) {
    const auto is = positions(joint);
    if (!is || is->at <= made_at_)
      return fmt::format("{} has not been read since its last change", joints_[joint].name);
    if (std::abs(is->position - last) > most)
      return fmt::format("{} is at {:g}, which is not within {:g} of {:g}", joints_[joint].name, is->position,
                         most, last);
  }
  return {};
}

}  // namespace coupler::host
