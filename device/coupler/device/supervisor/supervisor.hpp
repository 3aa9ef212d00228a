// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/signals.hpp"
#include "coupler/device/supervisor/safety_processes.hpp"
#include "coupler/device/supervisor/worker.hpp"

namespace coupler::device {

/// The work of a supervisor's worker processes. The supervisor makes the calls, unless a function says
/// otherwise, and no call may wait.
class Workload {
 public:
  /// The life of a worker process: answers clients, beginning with `clients`, until a signal asks to stop or
  /// the supervisor to make room; then it gives the supervisor its clients. After a signal it tries to leave
  /// its outputs in their safe state. Returns the exit status: 0 if it was asked to end.
  virtual int serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) = 0;
  /// The worker process reported that its loop turns.
  virtual void beat() {}

  /// That process (0: unknown) asked to reload, by SIGHUP. look_after() tells when it is done.
  virtual void reload(pid_t requester) = 0;
  /// Called every 100 ms or so. True: change() is to be called.
  virtual bool look_after(TimePoint now) = 0;
  /// There is no worker process: what reload() or look_after() prepared comes into force. Outputs stay as
  /// they are. Closes those of the clients that have to find out.
  virtual void change(std::vector<OpenConnection>& clients) = 0;

  // There is no worker process, and the outputs go to their safe state: in parts, each in a process of its
  // own and all at the same time, since lines can hang, and must not keep others from it.
  /// They are about to go there. Returns how many parts they have.
  virtual std::size_t begin_safe() = 0;
  /// Drives one of the parts: in the supervisor, too, if there is no process to be had. False: an output
  /// could not be driven.
  virtual bool drive_safe(std::size_t part) = 0;
  /// In the supervisor: what became of each part, safe, failed or hangs; those that are not safe are logged.
  /// True: end_durations() is to be called.
  virtual bool went_safe(const std::vector<SafeOutcome>& parts) = 0;
  /// Ends what was driven for a duration, and does not touch parts that hang. In a process of its own; in the
  /// supervisor if there is none to be had, and no part hangs. False: an output could not be driven.
  virtual bool end_durations(const std::vector<SafeOutcome>& parts) = 0;
  /// Makes safe what a firmware's code is behind, at the same time as the parts; never in the supervisor.
  virtual bool make_firmware_safe() = 0;
  virtual bool has_firmware() const = 0;

 protected:
  ~Workload() = default;
};

/// The pause before a process that ended is started again: doubled each time, short again after one that
/// lived long enough.
class Backoff {
 public:
  static constexpr std::chrono::milliseconds shortest{100};
  static constexpr std::chrono::milliseconds longest{5000};
  static constexpr std::chrono::seconds long_enough{10};

  std::chrono::milliseconds after(std::chrono::nanoseconds lived) {
    if (lived >= long_enough) next_ = shortest;
    const auto pause = next_;
    next_ = std::min(2 * next_, longest);
    return pause;
  }

 private:
  std::chrono::milliseconds next_ = shortest;
};

/// Holds the lines while another process works with them. Lines that nobody holds fall back to whatever pulls
/// them, so the process that holds them does as little as possible that could fail or wait. When the worker
/// process dies, or its loop stands still, the supervisor has the outputs driven to their safe state and
/// starts the worker process again. When lines or the map change, it replaces the worker process by one that
/// has the new ones, while outputs stay as they are.
class Supervisor {
 public:
  /// All of them outlive it.
  Supervisor(Loop& loop, Signals& signals, Workload& workload, Log& log)
      : loop_(loop), signals_(signals), workload_(workload), log_(log) {}

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
  /// One that was asked to end, or to make room. It is killed when it is silent for too long.
  Worker::End wait_for(Worker& process);
  Worker::End end(Worker& process);
  bool is_to_change(TimePoint now);
  bool has_lost_one_ended();
  void make_safe(bool firmware_too);
  void wait(std::chrono::milliseconds pause);

  Loop& loop_;
  Signals& signals_;
  Workload& workload_;
  Log& log_;
  bool to_change_ = false;    ///< the workload waits for change()
  bool is_safe_ = false;      ///< at the end of the last worker process
  std::string how_it_ended_;  ///< of the same
  std::vector<Child> lost_;   ///< killed, but not gone
};

}  // namespace coupler::device
