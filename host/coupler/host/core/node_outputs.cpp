// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/node_outputs.hpp"

#include <algorithm>

namespace coupler::host {
namespace {

using Kind = ScheduledOutcome::Result;
using modbus::Change;

/// A node tells at once; this is for one that is busy.
constexpr std::chrono::seconds told_within(1);
/// All that a node keeps, in replies that follow each other at once.
constexpr std::chrono::seconds all_told_within(2);
constexpr auto not_told = "the device could not report all its changes, and this outcome was among them";
/// Two clocks drift apart by less than this part of the time that passes.
constexpr int drift_part = 500;

std::optional<Kind> result_of(Change::Kind kind) {
  switch (kind) {
    case Change::Kind::done: return Kind::done;
    case Change::Kind::cancelled: return Kind::cancelled;
    case Change::Kind::failed: return Kind::failed;
    case Change::Kind::off:
    case Change::Kind::on: break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<modbus::NodeTime> NodeOutputs::node_due(Time due, const ClockMapping& mapping) const {
  std::optional<modbus::NodeTime> at = mapping.node_time(due);
  if (!at) return at;
  for (const Waiting& one : waiting_) {
    const Time other = one.what.what.due;
    const auto other_at = mapping.node_time(other);
    const bool has_jumped = !other_at || std::chrono::abs(*other_at - one.node_due) > told_within;
    if (has_jumped) continue;
    if (due <= other) at = std::min(*at, one.node_due);
    if (due >= other) at = std::max(*at, one.node_due);
  }
  return at;
}

void NodeOutputs::add(std::uint16_t number, modbus::NodeTime node_due, const AcceptedWrite& what) {
  settle(number, Kind::unknown, not_told);  // an older one is over, or the number would not be given again
  const Time due = what.what.due;
  waiting_.push_back({number, node_due, what, due + told_within + (due - clock_.now()) / drift_part});
}

std::optional<std::uint16_t> NodeOutputs::number_at_node(std::uint32_t number) const {
  for (const Waiting& one : waiting_)
    if (one.what.number == number) return one.number;
  return std::nullopt;
}

bool NodeOutputs::has(std::uint16_t number) const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [number](const Waiting& one) { return one.number == number; });
}

/// Each is taken before it is told: who is told may throw, and the next call goes on behind it.
template <class Which>
void NodeOutputs::settle_if(Which which, ScheduledOutcome::Result result, Stamp at,
                            const std::string& reason) {
  for (;;) {
    const auto found = std::find_if(waiting_.begin(), waiting_.end(), which);
    if (found == waiting_.end()) return;
    const AcceptedWrite what = found->what;
    waiting_.erase(found);
    outcomes_.on_outcome(what, result, at, reason);
  }
}

void NodeOutputs::settle(std::uint16_t number, ScheduledOutcome::Result result, const std::string& reason) {
  settle_if([number](const Waiting& which) { return which.number == number; }, result, {clock_.now(), {}},
            reason);
}

void NodeOutputs::on_written(std::uint32_t point) {
  for (Waiting& one : waiting_)
    if (one.what.what.write.point == point) one.what.is_overwritten = true;
}

void NodeOutputs::lose(const std::string& reason) {
  settle_if([](const Waiting&) { return true; }, Kind::unknown, {clock_.now(), {}}, reason);
}

void NodeOutputs::on_change(const Change& change, std::uint64_t number, Stamp stamp) {
  const auto result = result_of(change.kind);
  if (!result) {
    bits_.on_change(change, number, stamp);
    return;
  }
  const std::string reason = to_string(static_cast<modbus::Reason>(change.table));
  settle_if([&change](const Waiting& which) { return which.number == change.address; }, *result, stamp,
            reason);
}

/// The process that had accepted them serves no more, and no other one drives them.
void NodeOutputs::on_new_epoch() {
  bits_.on_new_epoch();
  const Time now = clock_.now();
  const auto has_time = [now](const Waiting& which) { return which.what.what.due - told_within > now; };
  settle_if(has_time, Kind::cancelled, {now, {}}, to_string(modbus::Reason::reload));
  lose("the device was restarted, or read a new map, before it had reported the outcome");
}

void NodeOutputs::on_heard(std::uint64_t newest, std::optional<Stamp> stamp) {
  bits_.on_heard(newest, stamp);
  // If more changes follow, the outcome may be among them. The wait for it is limited, because a node may
  // have more without end.
  const Time now = clock_.now();
  const Time told = stamp ? stamp->at : now - all_told_within;
  settle_if([told](const Waiting& which) { return which.told_by < told; }, Kind::unknown,
            stamp.value_or(Stamp{now, {}}), not_told);
}

void NodeOutputs::on_end() {
  bits_.on_end();
  lose(told_no_more);
}

}  // namespace coupler::host
