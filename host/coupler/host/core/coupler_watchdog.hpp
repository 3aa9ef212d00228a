// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/host/core/calls.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Makes use of the watchdog that a coupler has of its own, as Map::coupler_watchdog says: arms it at each
/// connect, feeds it, notices that it has expired, resets it and arms it again. Each write is a request by
/// itself.
///
/// ask_reset() is for any thread. All others belong to the one who uses the transport.
class CouplerWatchdog {
 public:
  /// What `map` views, and everything given by reference, must outlive it.
  CouplerWatchdog(const Map& map, PacedTransport& transport, Clock& clock, DeviceStatistics& statistics,
                  Sink& sink);

  /// Resets it, whether or not the map wants that done automatically.
  std::future<Calls::Answer> ask_reset() { return resets_.ask(); }

  /// A new connection, on which nothing has been written. An error means that it is of no more use.
  Result<> connected();
  /// There is no connection: who waits for a reset is told `why` there is none.
  void disconnected(const std::string& why);

  /// When step() has something to do; Time::max() if there is no watchdog.
  Time due() const;
  /// Does that. True: it had expired and is fed again; outputs are as the coupler left them.
  Result<bool> step();

 private:
  using State = WatchdogStatus::State;

  Result<bool> serve(bool may_reset);
  Result<bool> bring_up(bool may_reset);
  Result<> feed();
  Result<bool> is_expired();
  Result<bool> carry_out(Span<const WatchdogSequences::Write> steps);
  void expired();
  void trouble(State state, const std::string& what);
  void fed();

  Map map_;
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
