// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/keeper/charge.hpp"
#include "coupler/device/keeper/io_process.hpp"
#include "coupler/device/net/signals.hpp"

namespace coupler::device {

/// Holds the lines while another process works with them. Lines that nobody holds fall back to whatever pulls
/// them, so the process that holds them does as little as it can that could fail or wait: when the I/O
/// process dies, or its loop stands still, the keeper has the outputs driven to their safe state and starts
/// it anew. When lines or the map change, it replaces the I/O process by one that knows, while outputs stay
/// as they are.
class Keeper {
 public:
  /// For an I/O process that was asked to end. One that does not beat has as long as Silence says.
  static constexpr std::chrono::seconds patience{1};

  /// The charge shares what it knows with the I/O process. `heard` (may be null) is told of each beat of it.
  Keeper(Loop& loop, Signals& signals, Charge& charge, Log& log, Pulse* heard)
      : loop_(loop), signals_(signals), charge_(charge), log_(log), heard_(heard) {}

  /// Runs I/O processes until a signal asks to stop; then the outputs are in their safe state. False: one of
  /// them could not be driven.
  bool run();

 private:
  using Clients = std::vector<OpenConnection>;

  /// One I/O process, which begins with `clients`; they are those of the next one then. True: it made room,
  /// with its outputs as they are.
  bool run_one(Clients& clients);
  /// Until it ends, misses its beat, a signal asks to stop, or it has to make room for another one.
  IoProcess::End watch_over(IoProcess& process);
  IoProcess::End wait_for(IoProcess& process);
  IoProcess::End end(IoProcess& process);
  bool is_to_change(TimePoint now);
  bool has_lost_one_ended();
  void make_safe(bool firmware_too);
  void rest(std::chrono::milliseconds pause);

  Loop& loop_;
  Signals& signals_;
  Charge& charge_;
  Log& log_;
  Pulse* heard_;
  bool to_change_ = false;    ///< the charge waits for change()
  bool is_safe_ = false;      ///< at the end of the last I/O process
  std::string how_it_ended_;  ///< of the same
  std::vector<Child> lost_;   ///< killed, but not gone
};

}  // namespace coupler::device
