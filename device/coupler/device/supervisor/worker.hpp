// SPDX-License-Identifier: Apache-2.0
// Both ends of the socket pair between a supervisor and its worker process: Worker is the supervisor's end,
// SupervisorLink is the worker process's.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "coupler/device/net/loop.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/device/supervisor/child.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {

/// A worker process's connection to its supervisor. Each reports to the other that its loop turns. The
/// supervisor may ask the worker process to make room for another one, which then gets its clients.
class SupervisorLink : public EventHandler {
 public:
  /// `channel` is a connected socket that keeps messages apart.
  SupervisorLink(Descriptor channel, pid_t supervisor)
      : channel_(std::move(channel)), supervisor_(supervisor) {}

  /// The supervisor's process id; it may have ended.
  pid_t pid() const { return supervisor_; }

  /// Listens to it from now on.
  void watch(Loop& loop);

  /// Reports that the loop of this process turns. To be called once in each heartbeat_period.
  void beat();
  /// The supervisor asked this process to give its clients away and end.
  bool wants_room() const { return wants_room_; }
  void give(const OpenConnection& client);

  /// A supervisor that was silent for so long is stopped, or hangs, and would not see its worker process die.
  static constexpr std::chrono::seconds timeout = Silence::limit_in_any_case;
  /// To be asked in each turn of the loop.
  bool is_silent(TimePoint now);

  void ready(TimePoint now) override;

 private:
  Descriptor channel_;
  const pid_t supervisor_;
  Loop* loop_ = nullptr;
  bool wants_room_ = false;
  bool heard_ = true;  ///< since is_silent() was asked
  Silence silence_{TimePoint::clock::now(), heartbeat_period, std::chrono::nanoseconds(0)};
};

/// The process that drives lines and answers clients: a child with this process's memory and descriptors.
/// When this process dies, it gets SIGTERM. Without a terminal it has a process group of its own, which is an
/// orphan then: if it was stopped, the kernel makes it go on.
class Worker final : public EventHandler {
 public:
  /// Its work. This process is its supervisor.
  using Work = std::function<int(SupervisorLink&)>;

  /// Starts it; `loop` is this process's. `on_beat` is called for each of its beats. The error is an errno.
  static tl::expected<std::unique_ptr<Worker>, int> start(Loop& loop, const Work& work,
                                                          std::function<void()> on_beat);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  pid_t pid() const { return child_.pid(); }
  bool has_ended() const { return ended_; }
  /// The time of its last beat, or of its start.
  TimePoint last_beat() const { return last_beat_; }

  /// The signal that asks it to end: SIGINT or SIGTERM.
  void terminate(int signal);
  /// Reports that the loop of this process turns.
  void beat();
  /// Asks it to give its clients away and end.
  void make_room();
  /// Those that it gave away so far.
  std::vector<OpenConnection> take_clients() { return std::move(clients_); }

  struct End {
    bool in_order;  ///< of its own accord, with status 0
    bool is_gone;   ///< false: killed, but in a call of the kernel that does not end, and may drive lines yet
    std::string how;  ///< "exited with status 1", "was killed by signal 9 (Killed)"
  };
  /// Kills it unless it has ended.
  End end();
  /// The process that is not gone.
  Child take_child() { return std::move(child_); }

  void ready(TimePoint now) override;

 private:
  Worker(Loop& loop, Child child, Descriptor channel, std::function<void()> on_beat);

  Loop& loop_;
  Child child_;
  Descriptor channel_;  ///< at its end when the process is
  std::function<void()> on_beat_;
  TimePoint last_beat_;
  bool ended_ = false;
  std::vector<OpenConnection> clients_;
};

}  // namespace coupler::device
