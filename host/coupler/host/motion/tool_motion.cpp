// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/tool_motion.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

std::string_view word(bool on) { return on ? "on" : "off"; }

}  // namespace

std::string_view point_of(const Tool& tool, ToolPart part) {
  switch (part) {
    case ToolPart::close: return tool.close;
    case ToolPart::open: return tool.open;
    case ToolPart::closed: return tool.closed;
    case ToolPart::opened: return tool.opened;
    case ToolPart::holds: break;
  }
  return tool.holds;
}

/// The output that moves the tool, and how.
ToolMotion::Command ToolMotion::motive() const {
  if (has(output_of(goal_))) return {0, output_of(goal_), true};
  return {0, output_of(other_end(goal_)), false};
}

void ToolMotion::begin(ToolEnd end, Time now) {
  abort(How::replaced, "replaced by a newer goal " + after(now), now);
  has_goal_ = true;
  start(end, now);
}

void ToolMotion::start(ToolEnd end, Time now) {
  goal_ = end;
  since_ = now;
  has_driven_ = false;
  driven_ = {};
  if (const ToolPart partner = output_of(other_end(end)); motive().on && has(partner))
    send(partner, false, Phase::releasing);
  else
    drive();
  update(now, {});
}

void ToolMotion::send(ToolPart output, bool on, Phase phase) {
  phase_ = phase;
  driven(output).reset();
  last_ = {last_.number + 1, output, on};
  is_given_ = false;
}

void ToolMotion::drive() {
  const Command next = motive();
  send(next.output, next.on, Phase::driving);
}

void ToolMotion::cancel(Time now) {
  if (!has_goal_ || is_cancelled_ || phase_ == Phase::letting_go) return;
  is_cancelled_ = true;
  result_ = {How::cancelled, "cancelled " + after(now)};
  if (tool_.on_cancel == OnCancel::stay) {
    // A command that is on its way cannot be taken back.
    if (std::exchange(is_given_, true) && phase_ != Phase::moving)
      phase_ = Phase::stopping;
    else
      finish(now);
    return;
  }
  const ToolEnd end = tool_.on_cancel == OnCancel::open ? ToolEnd::open : ToolEnd::closed;
  if (goal_ != end) return start(end, now);
  if (phase_ == Phase::moving) give_result();
}

/// A command that has not been taken yet is dropped.
void ToolMotion::abort(How how, const std::string& why, Time now) {
  if (phase_ == Phase::idle) return;
  is_given_ = true;
  result_ = {how, why};
  finish(now);
}

void ToolMotion::disturb(const std::string& why, Time now) {
  driven_ = {};
  rest_.reset();
  abort(How::aborted, why, now);
  update(now, {});
}

void ToolMotion::go_offline(Time now) {
  for (Level& each : levels_) each.known = false;
  disturb("the connection to the device was lost " + after(now), now);
}

bool ToolMotion::see(ToolPart part, bool on, const Stamp& stamp, Time now) {
  Level& seen = level(part);
  const bool is_news = !seen.known || seen.on != on;
  if (is_news) {
    seen = {true, on, stamp, stamp, false};
    if (on && phase_ != Phase::moving && (part == ToolPart::closed || part == ToolPart::opened))
      rest_.reset();
  }
  seen.last = stamp;
  seen.asked = false;
  if (rest_ == ToolState::stuck && phase_ == Phase::idle && is_there()) rest_.reset();
  if (is_output(part)) check_output(part, on, stamp, now);
  look(now);
  return is_news || is_status_new_ || !is_given_ || !results_.empty();
}

/// Somebody else has written it, who may have the tool's other output, too.
void ToolMotion::check_output(ToolPart output, bool on, const Stamp& stamp, Time now) {
  std::optional<Driven>& as = driven(output);
  if (!as || as->on == on || stamp.at - stamp.uncertainty < as->since) return;
  disturb(fmt::format("{} was switched {} by something else {}", name(output), word(on), after(now)), now);
}

void ToolMotion::lose(ToolPart part, Time now) {
  level(part).known = false;
  look(now);
}

void ToolMotion::on_written(std::uint64_t number, const std::string& failure, Time now) {
  if (number != last_.number || phase_ == Phase::idle) return;  // of a goal that has ended
  if (!failure.empty()) {
    const std::string switched =
        fmt::format("{} could not be switched {}: {}", name(last_.output), word(last_.on), failure);
    return abort(How::aborted,
                 phase_ == Phase::letting_go ? fmt::format("{}, but {}", result_.text, switched) : switched,
                 now);
  }
  driven(last_.output) = Driven{last_.on, now};
  if (phase_ == Phase::letting_go || phase_ == Phase::stopping) return finish(now);
  if (phase_ == Phase::releasing) return drive();
  phase_ = Phase::moving;
  since_ = now;
  if (is_cancelled_) give_result();
  for (Level& each : levels_) each.asked = false;
  look(now);
}

/// The value is not older than the motion.
bool ToolMotion::is_since_driven(ToolPart input) const {
  const Level& seen = level(input);
  return seen.known && seen.last.at - seen.last.uncertainty >= since_;
}
bool ToolMotion::is_seen_on(ToolPart input) const {
  const Level& seen = level(input);
  return has(input) && is_since_driven(input) && seen.on && seen.last.at - seen.first.at >= tool_.settle;
}
bool ToolMotion::is_seen_off(ToolPart input) const {
  return !has(input) || (is_since_driven(input) && !level(input).on);
}

bool ToolMotion::is_at_end(Time now) const {
  const ToolPart input = input_of(goal_);
  return has(input) ? is_seen_on(input) : now >= end_at();
}

/// The time at which it is at the end of the goal, as far as is known; Time::max() if it is not.
Time ToolMotion::end_at() const {
  const ToolPart input = input_of(goal_);
  if (!has(input)) return since_ + Duration(tool_.travel);
  return is_on(input) ? level(input).first.at + Duration(tool_.settle) : Time::max();
}

/// A part may be seen as late as the end is reached, and by the same reading.
bool ToolMotion::is_without_part() const {
  return is_seen_off(ToolPart::holds) && level(ToolPart::holds).last.at >= end_at();
}

/// Its inputs say that it is where the goal has led to.
bool ToolMotion::is_there() const {
  if (is_on(input_of(other_end(goal_)))) return false;
  return is_on(input_of(goal_)) || (counts(ToolPart::holds) && is_on(ToolPart::holds));
}

/// Returns whether the motion has ended, with which arrive() has dealt then.
bool ToolMotion::ends(Time now) {
  const bool has_left = is_seen_off(input_of(other_end(goal_)));
  const bool may_hold = counts(ToolPart::holds);
  const bool timed = !has(input_of(goal_));
  const std::optional<ToolState> rest =
      timed ? std::optional(goal_ == ToolEnd::closed ? ToolState::closed : ToolState::open) : std::nullopt;
  if (has_left && may_hold && is_seen_on(ToolPart::holds))
    arrive(How::holds, "holds a part " + after(now), rest, now);
  else if (has_left && is_at_end(now) && may_hold && is_without_part() && tool_.empty == OnEmpty::abort)
    arrive(How::stuck, "closed without a part " + after(now), rest, now);
  else if (has_left && is_at_end(now) && (!may_hold || is_without_part()))
    arrive(How::reached,
           fmt::format("{} {}{}", goal_ == ToolEnd::closed ? "closed" : "open", after(now),
                       timed ? ", its travel time" : ""),
           rest, now);
  else if (now - since_ >= tool_.timeout)
    arrive(How::stuck, fmt::format("{} {}", why_stuck(), after(now)),
           is_contradictory() ? std::nullopt : std::optional(ToolState::stuck), now);
  else
    return false;
  return true;
}

/// Decides whether the goal has ended, and updates the state.
void ToolMotion::look(Time now) {
  if (phase_ != Phase::moving || !ends(now)) update(now, {});
}

/// The motion has ended.
void ToolMotion::arrive(How how, std::string text, std::optional<ToolState> rest, Time now) {
  const Command last = motive();
  const bool lets_go = last.on && !tool_.hold;
  if (how == How::stuck && !lets_go) text += fmt::format(" ({} is {})", name(last.output), word(last.on));
  result_ = {how, std::move(text)};
  rest_ = rest;
  if (!lets_go) return finish(now);
  send(last.output, false, Phase::letting_go);
}

void ToolMotion::finish(Time now) {
  phase_ = Phase::idle;
  const std::string text = result_.text;
  if (has_goal_) give_result();
  update(now, text);
}

void ToolMotion::give_result() {
  results_.push_back(std::exchange(result_, {}));
  has_goal_ = is_cancelled_ = false;
}

Time ToolMotion::step(Time now) {
  look(now);
  if (phase_ != Phase::moving) return Time::max();
  Time next = since_ + tool_.timeout;
  if (const Time end = end_at(); !has(input_of(goal_)) && now < end) next = std::min(next, end);
  return std::min(next, ask(now));
}

/// A device that announces changes says no more of an input that stays as it is, or whose change may have
/// been before the motion.
Time ToolMotion::ask(Time now) {
  Time next = Time::max();
  for (const ToolPart input : tool_inputs) {
    Level& seen = level(input);
    Time due = Time::min();
    if (is_on(input))
      due = seen.first.at + Duration(tool_.settle);
    else if (const Time end = end_at(); input == ToolPart::holds && counts(input) && end != Time::max())
      due = end;
    if (!has(input) || seen.asked || (is_since_driven(input) && seen.last.at >= due)) continue;
    if (is_since_driven(input) && now < due) {
      next = std::min(next, due);
    } else {
      seen.asked = true;
      asked_.push_back(input);
    }
  }
  return next;
}

/// "after 212 ms". `now` may be before since_: a goal may arrive just before the last command of the goal
/// that it replaces is acknowledged.
std::string ToolMotion::after(Time now) const {
  const Duration passed = std::max(now - since_, Duration::zero());
  return fmt::format("after {} ms", std::chrono::round<std::chrono::milliseconds>(passed).count());
}

std::optional<ToolMotion::Command> ToolMotion::take_command() {
  if (std::exchange(is_given_, true)) return std::nullopt;
  if (!std::exchange(has_driven_, true)) rest_.reset();  // until then the tool has not moved
  return last_;
}
std::vector<ToolPart> ToolMotion::take_asked() { return std::exchange(asked_, {}); }
std::optional<ToolStatus> ToolMotion::take_status() {
  if (!std::exchange(is_status_new_, false)) return std::nullopt;
  return status_;
}
std::vector<ToolResult> ToolMotion::take_results() { return std::exchange(results_, {}); }

}  // namespace coupler::host
