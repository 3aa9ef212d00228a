// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/watchdog.hpp"

namespace coupler::host {

// The requests that a coupler's own watchdog needs. An exception is an answer here, unless it says that the
// unit is away.

/// A write that the coupler answered with an exception.
struct RejectedStep {
  WatchdogSequences::Write step;
  modbus::Exception code;
};

/// Returns a text as "writing 5 to holding_registers 4096: exception 02 (illegal data address)", and what to
/// do about it.
std::string to_string(const RejectedStep& rejected);

/// Sends the writes (FC 5 or 6) in order, up to the first one that is rejected.
Result<std::optional<RejectedStep>> write_steps(Span<const WatchdogSequences::Write> steps, const Map& map,
                                                Link& link);

/// Returns whether the place holds the value, and false if it cannot be read.
Result<bool> has_value(const WatchdogSequences::Write& place, const Map& map, Link& link);

/// Uses the coupler's own watchdog as Map::coupler_watchdog says: arms it at each connect, feeds it, notices
/// that it has expired, resets it and arms it again. Each write is a request of its own.
///
/// Any thread may call ask_reset(). Only the thread that uses the link may call the other functions.
class CouplerWatchdog {
 public:
  /// All references must outlive the object.
  CouplerWatchdog(const Map& map, Link& link, DeviceStatistics& statistics, Sink& sink);

  /// Resets the watchdog, even if the map wants no automatic reset.
  std::future<CallAnswer> ask_reset() { return resets_.ask(); }

  /// Starts with a new connection, before anything is written. An error means that the connection can no
  /// longer be used.
  Result<> connected();
  /// Answers the resets that wait with `why`, because the connection has ended.
  void disconnected(const std::string& why);

  /// The time at which step() has something to do while connected; Time::max() if there is no watchdog.
  Time due() const;
  /// Feeds the watchdog, or tries to reset it. Returns true if it had expired and is fed again. The outputs
  /// are then as the coupler left them.
  Result<bool> step();

 private:
  using State = WatchdogStatus::State;

  Result<bool> serve(bool may_reset);
  Result<bool> bring_up(bool may_reset);
  Result<> feed();
  Result<bool> is_expired();
  Result<bool> carry_out(Span<const WatchdogSequences::Write> steps);
  void expired();
  void report_failure(State state, const std::string& what);
  void fed();

  const Map& map_;
  WatchdogSequences known_;
  Link& link_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  Sink& sink_;
  WatchdogStatus status_;
  std::size_t turn_ = 0;  ///< the index of the next write in WatchdogSequences::feed
  Time next_{};           ///< the time to feed, or to try again
  Calls resets_;
};

}  // namespace coupler::host
