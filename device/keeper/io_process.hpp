// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "device/keeper/pulse.hpp"
#include "device/net/loop.hpp"

namespace coupler::node {

/// The process that drives lines and answers masters: a child with this process's memory and descriptors.
/// When this process dies, it gets SIGTERM.
class IoProcess : public Watcher {
 public:
  /// What it does; the pulse tells this process that its loop turns.
  using Work = std::function<int(Pulse&)>;

  /// Starts it; `loop` is this process's. `heard` (may be null) is told of each of its beats. The error is an
  /// errno.
  static tl::expected<std::unique_ptr<IoProcess>, int> start(Loop& loop, const Work& work, Pulse* heard);
  IoProcess(const IoProcess&) = delete;
  IoProcess& operator=(const IoProcess&) = delete;
  ~IoProcess();

  bool has_ended() const { return ended_; }
  /// Of its last beat, or of its start.
  TimePoint last_beat() const { return last_beat_; }

  void terminate();
  /// Kills it unless it has ended, and waits until it is gone: it drives no line any more. Tells how it
  /// ended: "exited with status 1", "was killed by signal 9 (Killed)".
  std::string end();

  void ready(TimePoint now) override;

 private:
  IoProcess(Loop& loop, pid_t pid, Descriptor beats, Pulse* heard);

  Loop& loop_;
  pid_t pid_;
  Descriptor beats_;  ///< a byte each; at its end when the process is
  Pulse* heard_;
  TimePoint last_beat_;
  bool ended_ = false;
};

}  // namespace coupler::node
