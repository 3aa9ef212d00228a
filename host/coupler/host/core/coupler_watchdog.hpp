// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/host/core/calls.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
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

/// "writing 5 to holding_registers 4096: exception 02 (illegal data address)", and what to do about it.
std::string to_string(const RejectedStep& rejected);

/// Makes the writes (FC 5 or 6) in order, up to the first that is rejected.
Result<std::optional<RejectedStep>> write_steps(Span<const WatchdogSequences::Write> steps,
                                                Transport& transport);

/// Whether the place holds the value. False if it cannot be read.
Result<bool> has_value(const WatchdogSequences::Write& place, Transport& transport);

/// Uses the coupler's own watchdog as Map::coupler_watchdog says: arms it at each connect, feeds it, notices
/// that it has expired, resets it and arms it again. Each write is a request of its own.
///
/// ask_reset() may be called from any thread, all else only from the one that uses the transport.
class CouplerWatchdog {
 public:
  /// Everything given by reference must outlive it.
  CouplerWatchdog(const Map& map, PacedTransport& transport, Clock& clock, DeviceStatistics& statistics,
                  Sink& sink);

  /// Resets it, also where the map wants no automatic reset.
  std::future<Calls::Answer> ask_reset() { return resets_.ask(); }

  /// A new connection, on which nothing has been written. An error means that it can no longer be used.
  Result<> connected();
  /// There is no connection: resets that wait are answered with `why`.
  void disconnected(const std::string& why);

  /// When step() has something to do; Time::max() if there is no watchdog.
  Time due() const;
  /// Does it. True if it had expired and is fed again; outputs are as the coupler left them.
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
  PacedTransport& transport_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  Sink& sink_;
  WatchdogStatus status_;
  bool connected_ = false;
  std::size_t turn_ = 0;  ///< the next of WatchdogSequences::feed
  Time next_{};           ///< when to feed, or to try again
  Calls resets_;
};

}  // namespace coupler::host
