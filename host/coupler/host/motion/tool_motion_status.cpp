// SPDX-License-Identifier: Apache-2.0
// This file decides what the state of a tool is, and finds the words for it.
#include "coupler/host/motion/tool_motion.hpp"

#include <fmt/format.h>

namespace coupler::host {

ToolState ToolMotion::state() const {
  if (phase_ != Phase::idle) return goal_ == ToolEnd::closed ? ToolState::closing : ToolState::opening;
  if (rest_ == ToolState::stuck) return ToolState::stuck;
  if (is_contradictory()) return ToolState::contradictory;
  if (is_on(ToolPart::opened)) return ToolState::open;
  if (is_on(ToolPart::holds) && rest_ != ToolState::open) return ToolState::holding;
  if (is_on(ToolPart::closed)) return ToolState::closed;
  return rest_.value_or(ToolState::unknown);
}

std::string ToolMotion::reason_of(ToolState state) const {
  if (state == ToolState::contradictory)
    return fmt::format("{} and {} are both on", name(ToolPart::closed), name(ToolPart::opened));
  if (state != ToolState::unknown) return {};
  for (const ToolPart input : tool_inputs)
    if (has(input) && !level(input).known) return fmt::format("no value of {}", name(input));
  return has(ToolPart::closed) || has(ToolPart::opened) ? "no input says that it is at an end"
                                                        : "it has no input that says where it is";
}

void ToolMotion::update(Time now, const std::string& reason) {
  const ToolState is = state();
  const bool stays = is == status_.state;
  if (stays && reason.empty() && (is != ToolState::unknown || is_reason_of_goal_)) return;
  std::string why = reason.empty() ? reason_of(is) : reason;
  is_reason_of_goal_ = !reason.empty();
  if (stays && why == status_.reason) return;
  status_ = {is, stays ? status_.since : now, std::move(why)};
  is_status_new_ = true;
}

std::optional<double> ToolMotion::position() const {
  const JointPositions& ends = tool_.positions;
  const double middle = (ends.open + ends.closed) / 2;
  switch (state()) {
    case ToolState::open: return ends.open;
    case ToolState::closed: return ends.closed;
    case ToolState::holding: {
      const Level& closed = level(ToolPart::closed);
      return closed.known && !closed.on ? middle : ends.closed;
    }
    case ToolState::opening:
    case ToolState::closing:
    case ToolState::stuck:
    case ToolState::unknown: return middle;
    case ToolState::contradictory: break;
  }
  return std::nullopt;
}

Time ToolMotion::there_since() const {
  const ToolState is = state();
  const bool is_seen = is == ToolState::unknown || is == ToolState::holding ||
                       (is == ToolState::open && is_on(ToolPart::opened)) ||
                       (is == ToolState::closed && is_on(ToolPart::closed));
  return is_seen ? Time::min() : status_.since;
}

/// "stuck: neither end", which a time follows.
std::string ToolMotion::why_stuck() const {
  for (const ToolPart input : tool_inputs)
    if (counts(input) && !is_since_driven(input))
      return fmt::format("stuck: no new value of {}", name(input));
  if (is_contradictory()) return reason_of(ToolState::contradictory);
  if (const ToolPart back = input_of(other_end(goal_)); is_on(back))
    return fmt::format("stuck: {} is still on", name(back));
  for (const ToolPart input : {input_of(goal_), ToolPart::holds})
    if (counts(input) && is_on(input) && !is_seen_on(input))
      return fmt::format("stuck: {} has not settled", name(input));
  return "stuck: neither end";
}

}  // namespace coupler::host
