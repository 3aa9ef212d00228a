// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/scheduled.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::host {
namespace {

constexpr std::chrono::milliseconds most_past(1);
constexpr std::chrono::hours most_ahead(1);

double in_seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

bool WritesFrom::has(const ScheduledWrite& what) const {
  return what.due >= from && (owner == 0 || what.owner == owner) &&
         std::find(points.begin(), points.end(), what.write.point) != points.end();
}

std::string why_impossible(const ScheduledWrite& what, Time now) {
  if (what.due < now - std::max<Duration>(most_past, what.may_be_late))
    return fmt::format(
        "its time is {:.3f} s in the past; send a future time, by this machine's clock (not a simulation's)",
        in_seconds(now - what.due));
  if (what.due > now + most_ahead)
    return fmt::format("its time is {:.0f} s ahead, and an hour (3600 s) is the most; ask again later",
                       in_seconds(what.due - now));
  if (what.duration < std::chrono::milliseconds::zero() || what.duration > modbus::longest_duration)
    return fmt::format("it would last {:.3f} s; send 0, for good, or up to an hour (3600 s)",
                       in_seconds(what.duration));
  return {};
}

std::string to_string(modbus::Reason reason) {
  using modbus::Reason;
  switch (reason) {
    case Reason::none: return {};
    case Reason::client: return "its client cancelled it";
    case Reason::overwritten: return "another write to the same point";
    case Reason::watchdog: return "the watchdog expired";
    case Reason::safe_state: return "the outputs went to their safe state";
    case Reason::reload: return "the device read a new map, lost or found a chip, or ended";
    case Reason::connection: return "the connection ended";
    case Reason::hardware: return "the output could not be driven, or does not take the value";
    case Reason::locked: return "the watchdog keeps outputs in their safe state until it is reset";
  }
  return fmt::format("reason {}, which this driver does not know", static_cast<int>(reason));
}

}  // namespace coupler::host
