// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

#include "device/net/loop.hpp"

namespace coupler::node {

/// Turns SIGINT, SIGTERM and SIGHUP into a request to stop, which the loop sees in its own time. A SIGHUP
/// that is ignored at the start (nohup) stays ignored; SIGPIPE is. To be made before any thread is started.
class Signals : public Watcher {
 public:
  explicit Signals(Loop& loop);
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  ~Signals();

  /// The signal that asked to stop; 0: none did.
  int stop() const { return stop_; }

  void ready(TimePoint now) override;

 private:
  Loop& loop_;
  sigset_t stopping_{};
  Descriptor descriptor_;
  int stop_ = 0;
};

}  // namespace coupler::node
