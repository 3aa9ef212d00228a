// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <csignal>
#include <optional>
#include <utility>

#include "coupler/device/net/loop.hpp"

namespace coupler::device {

/// Returns whether this process has a controlling terminal. One that was closed does not count.
bool has_terminal();

/// Turns SIGINT and SIGTERM into a request to stop and SIGHUP into one to reload, which the loop sees in its
/// own time. The SIGHUP of a terminal that is closed is a request to stop. A SIGHUP that is ignored at the
/// start (nohup) stays ignored; SIGPIPE is. SIGTSTP, which Ctrl-Z sends, is only noted. To be made before any
/// thread is started. The signals are blocked meanwhile, and afterwards if they were before: in a process
/// that was forked by one with Signals they stay so, and a second request to stop does not kill it at its
/// end.
class Signals : public EventHandler {
 public:
  explicit Signals(Loop& loop);
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  ~Signals();

  /// The signal that asked to stop; 0: none did.
  int stop() const { return stop_; }
  /// The process that sent the last SIGHUP since the last call; 0: the kernel.
  std::optional<pid_t> take_reload() { return std::exchange(reload_, std::nullopt); }
  /// Returns whether SIGTSTP came since the last call.
  bool take_suspend() { return std::exchange(suspend_, false); }

  void ready(TimePoint now) override;

 private:
  Loop& loop_;
  bool has_terminal_;
  sigset_t signals_{};
  sigset_t blocked_before_{};
  Descriptor descriptor_;
  int stop_ = 0;
  std::optional<pid_t> reload_;
  bool suspend_ = false;
};

}  // namespace coupler::device
