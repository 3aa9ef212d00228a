// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "coupler/device/net/loop.hpp"
#include "coupler/device/supervisor/child.hpp"
#include "coupler/device/supervisor/supervisor_link.hpp"

namespace coupler::device {

/// The process that drives lines and answers clients: a child with this process's memory and descriptors.
/// When this process dies, it gets SIGTERM. Without a terminal it has a process group of its own, which is an
/// orphan then: if it was stopped, the kernel makes it go on.
class Worker : public Watcher {
 public:
  /// What it does; this process is its supervisor.
  using Work = std::function<int(SupervisorLink&)>;

  /// Starts it; `loop` is this process's. `heard` (may be null) is told of each of its beats. The error is an
  /// errno.
  static tl::expected<std::unique_ptr<Worker>, int> start(Loop& loop, const Work& work, Heartbeat* heard);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  pid_t pid() const { return child_.pid(); }
  bool has_ended() const { return ended_; }
  /// Of its last beat, or of its start.
  TimePoint last_beat() const { return last_beat_; }

  /// The signal that asks it to end: SIGINT or SIGTERM.
  void terminate(int signal);
  /// Lets it know that this process is alive.
  void beat();
  /// Asks it to give its clients away and end.
  void make_room();
  /// Those that it gave away so far.
  std::vector<OpenConnection> take_clients() { return std::move(clients_); }

  struct End {
    bool in_order;    ///< of its own accord, with status 0
    bool is_gone;     ///< false: killed, but in a call of the kernel that does not end; what that drives, it
                      ///< drives
    std::string how;  ///< "exited with status 1", "was killed by signal 9 (Killed)"
  };
  /// Kills it unless it has ended.
  End end();
  /// What is left of one that is not gone.
  Child take_child() { return std::move(child_); }

  void ready(TimePoint now) override;

 private:
  Worker(Loop& loop, Child child, Descriptor channel, Heartbeat* heard);

  Loop& loop_;
  Child child_;
  Descriptor channel_;  ///< at its end when the process is
  Heartbeat* heard_;
  TimePoint last_beat_;
  bool ended_ = false;
  std::vector<OpenConnection> clients_;
};

}  // namespace coupler::device
