// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/core/lines.hpp"
#include "device/core/log.hpp"
#include "device/keeper/io_process.hpp"
#include "device/net/signals.hpp"

namespace coupler::node {

/// Holds the lines while another process works with them. Lines that nobody holds fall back to whatever pulls
/// them, so the process that holds them does nothing else that could fail: when the I/O process dies, or its
/// loop stands still, the keeper drives the outputs to their safe state and starts it anew.
class Keeper {
 public:
  /// An I/O process that has not beaten for so long is killed.
  static constexpr std::chrono::seconds patience{1};

  /// `lines` share what they know with the I/O process. `heard` (may be null) is told of each beat of it.
  Keeper(Loop& loop, const Signals& signals, Lines& lines, Log& log, Pulse* heard)
      : loop_(loop), signals_(signals), lines_(lines), log_(log), heard_(heard) {}

  /// Runs I/O processes until a signal asks to stop; then the outputs are in their safe state. False: one of
  /// them could not be driven.
  bool run(const IoProcess::Work& work);

 private:
  /// Until it ends, misses its beat, or a signal asks to stop. Tells how it ended.
  std::string watch_over(IoProcess& process);
  std::string end_in_peace(IoProcess& process);
  void rest(std::chrono::milliseconds pause);

  Loop& loop_;
  const Signals& signals_;
  Lines& lines_;
  Log& log_;
  Pulse* heard_;
};

}  // namespace coupler::node
