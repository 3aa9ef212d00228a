// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "device/core/log.hpp"
#include "device/gpio/make_lines.hpp"
#include "device/keeper/pulse.hpp"
#include "device/net/signals.hpp"
#include "device/net/tcp_server.hpp"
#include "device/node/edge_watcher.hpp"
#include "device/node/node.hpp"

namespace coupler::node {

/// Answers masters with the lines of a map: all that happens between the start and the end of a node.
class IoService {
 public:
  /// All of them outlive it.
  IoService(const Map& map, Wiring& wiring, Memory& memory, Listener listener, Loop& loop, Log& log);

  /// Serves until a signal asks to stop, then drives the outputs to their safe state. `pulse` (may be null)
  /// is told that the loop turns.
  void run(const Signals& signals, Pulse* pulse);

 private:
  void turn(std::optional<std::chrono::milliseconds> at_most);
  void log_trips();

  Lines& lines_;
  Loop& loop_;
  Log& log_;
  std::deque<EdgeWatcher> watchers_;
  const Statistics& statistics_;
  Node node_;
  TcpServer tcp_;
  TimePoint now_;
  std::uint32_t trips_;  ///< of the watchdog, in the log
};

}  // namespace coupler::node
