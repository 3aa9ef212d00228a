// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/core/log.hpp"
#include "device/keeper/charge.hpp"
#include "device/keeper/io_process.hpp"
#include "device/net/signals.hpp"

namespace coupler::node {

/// Holds the lines while another process works with them. Lines that nobody holds fall back to whatever pulls
/// them, so the process that holds them does as little as it can that could fail: when the I/O process dies,
/// or its loop stands still, the keeper drives the outputs to their safe state and starts it anew. When lines
/// or the map change, it replaces the I/O process by one that knows, while outputs stay as they are.
class Keeper {
 public:
  /// An I/O process that has not beaten for so long is killed.
  static constexpr std::chrono::seconds patience{1};

  /// The charge shares what it knows with the I/O process. `heard` (may be null) is told of each beat of it.
  Keeper(Loop& loop, Signals& signals, Charge& charge, Log& log, Pulse* heard)
      : loop_(loop), signals_(signals), charge_(charge), log_(log), heard_(heard) {}

  /// Runs I/O processes, the first one with `clients`, until a signal asks to stop; then the outputs are in
  /// their safe state. False: one of them could not be driven.
  bool run(std::vector<OpenConnection> clients);

 private:
  /// Until it ends, misses its beat, a signal asks to stop, or it has to make room for another one.
  IoProcess::End watch_over(IoProcess& process);
  IoProcess::End wait_for(IoProcess& process);
  bool is_to_change(TimePoint now);
  void rest(std::chrono::milliseconds pause);

  Loop& loop_;
  Signals& signals_;
  Charge& charge_;
  Log& log_;
  Pulse* heard_;
  bool to_change_ = false;  ///< the charge waits for change()
  TimePoint next_look_{};
};

}  // namespace coupler::node
