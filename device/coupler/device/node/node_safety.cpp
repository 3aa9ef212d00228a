// SPDX-License-Identifier: Apache-2.0
// How the outputs of a node go to their safe state when no worker process drives them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "coupler/device/core/each_point.hpp"
#include "coupler/device/core/timed_output_end.hpp"
#include "coupler/device/node/node_runtime.hpp"
#include "coupler/device/node/output_parts.hpp"
#include "coupler/device/node/realtime.hpp"

namespace coupler::device {
namespace {

/// Ends the durations of a worker process that serves no more.
struct Ending {
  explicit Ending(ServingContext& context)
      : schedule(context.state->scheduled()),
        hardware(context.hardware()),
        end(*context.map, context.state->image(), hardware, schedule, next) {}

  OutputSchedule schedule;
  Hardware hardware;
  std::array<std::uint16_t, modbus::max_scheduled_bits> next{};
  TimedOutputEnd end;
  TimePoint now = TimePoint::clock::now();
};

/// Returns whether only a firmware's code is behind the output. That code hears of the end of a pulse, and is
/// called in the worker process only: the next worker ends the pulse.
bool is_for_code(const ServingContext& context, const ScheduledOutput& begun) {
  const auto points = touched_points(*context.map, begun.table, begun.range);
  return context.hooked && std::none_of(points.begin(), points.end(), has_hardware) &&
         std::any_of(points.begin(), points.end(), is_pulsed);
}

}  // namespace

std::size_t NodeRuntime::begin_safe() {
  // If a process is killed while they are driven, the next worker process brings none of them back.
  OutputSchedule(context_->state->scheduled()).outputs_went_safe(false, TimePoint::clock::now());
  return OutputParts(*context_).size();
}

/// A process that was forked for this has ordinary priority, and only a second. The supervisor has this
/// priority already.
void NodeRuntime::hurry() const {
  if (options_.realtime) (void)take_priority(RealtimePriority::supervisor);
}

bool NodeRuntime::drive_safe(std::size_t part) {
  hurry();
  return OutputParts(*context_).drive_safe(part);
}

bool NodeRuntime::went_safe(const std::vector<SafeOutcome>& parts) {
  const OutputParts outputs(*context_);
  bool all = true;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (parts[part] == SafeOutcome::safe) continue;
    all = false;
    log_.warn(fmt::format(
        "the outputs of {} could not be driven to their safe state{}; they may be as they were",
        outputs.name(part), parts[part] == SafeOutcome::hangs ? ": the call to the kernel hangs" : ""));
  }
  const TimePoint now = TimePoint::clock::now();
  OutputWatchdog& watchdog = context_->state->watchdog();
  // It may have expired in the process that hung meanwhile. What failed is tried again; what hangs has its
  // turn when the call ends.
  const bool any_failed = std::count(parts.begin(), parts.end(), SafeOutcome::failed) != 0;
  if (watchdog.state() == OutputWatchdog::State::armed && watchdog.is_due(now))
    watchdog.expire(!any_failed, now);
  else
    watchdog.disarm();
  const auto scheduled = context_->state->scheduled();
  OutputSchedule(scheduled).outputs_went_safe(all, now);
  return std::any_of(scheduled.begin(), scheduled.end(),
                     [](const ScheduledOutput& one) { return one.state == ScheduledOutput::State::begun; });
}

bool NodeRuntime::end_durations(const std::vector<SafeOutcome>& parts) {
  hurry();
  OutputParts outputs(*context_);
  for (std::size_t part = 0; part < parts.size(); ++part)
    if (parts[part] == SafeOutcome::hangs) outputs.give_up(part);
  Ending ending(*context_);
  // The next worker process may be long in coming.
  bool ended = true;
  ending.schedule.each_begun([&](ScheduledOutput& begun) {
    if (!is_for_code(*context_, begun)) ended &= ending.end.of(begun, ending.now);
  });
  return ended;
}

/// The new map has its points elsewhere, or has them no longer.
void NodeRuntime::end_durations_that_do_not_fit() {
  Ending ending(*context_);
  ending.schedule.each_begun([&](ScheduledOutput& begun) {
    if (next_->state->fits(begun, *context_->state) || ending.end.of(begun, ending.now)) return;
    log_.warn(
        fmt::format("{} {} to {}: not every output could be driven back at the end of its duration, and the "
                    "new map has other outputs there or none: those stay as they are until they are written",
                    to_string(begun.table), begun.range.start(), begun.range.last()));
  });
}

bool NodeRuntime::make_firmware_safe() { return hooks_->end(context_->state->image()); }

}  // namespace coupler::device
