// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/signals.hpp"
#include "coupler/device/supervisor/worker.hpp"
#include "coupler/device/supervisor/workload.hpp"

namespace coupler::device {

/// Holds the lines while another process works with them. Lines that nobody holds fall back to whatever pulls
/// them, so the process that holds them does as little as it can that could fail or wait: when the I/O
/// process dies, or its loop stands still, the supervisor has the outputs driven to their safe state and
/// starts it anew. When lines or the map change, it replaces the worker process by one that knows, while
/// outputs stay as they are.
class Supervisor {
 public:
  /// For a worker process that was asked to end. One that does not beat has as long as Silence says.
  static constexpr std::chrono::seconds timeout{1};

  /// The workload shares what it knows with the worker process. `heard` (may be null) is told of each beat of
  /// it.
  Supervisor(Loop& loop, Signals& signals, Workload& workload, Log& log, Heartbeat* heard)
      : loop_(loop), signals_(signals), workload_(workload), log_(log), heard_(heard) {}

  /// Runs worker processes until a signal asks to stop; then the outputs are in their safe state. False: one
  /// of them could not be driven.
  bool run();

 private:
  using Clients = std::vector<OpenConnection>;

  /// One worker process, which begins with `clients`; they are those of the next one then. True: it made
  /// room, with its outputs as they are.
  bool run_one(Clients& clients);
  /// Until it ends, misses its beat, a signal asks to stop, or it has to make room for another one.
  Worker::End watch_over(Worker& process);
  Worker::End wait_for(Worker& process);
  Worker::End end(Worker& process);
  bool is_to_change(TimePoint now);
  bool has_lost_one_ended();
  void make_safe(bool firmware_too);
  void rest(std::chrono::milliseconds pause);

  Loop& loop_;
  Signals& signals_;
  Workload& workload_;
  Log& log_;
  Heartbeat* heard_;
  bool to_change_ = false;    ///< the workload waits for change()
  bool is_safe_ = false;      ///< at the end of the last worker process
  std::string how_it_ended_;  ///< of the same
  std::vector<Child> lost_;   ///< killed, but not gone
};

}  // namespace coupler::device
