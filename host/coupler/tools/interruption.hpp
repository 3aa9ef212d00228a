// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace coupler::tools {

/// While it exists, the first of coupler::ending_signals (Ctrl-C, a closed terminal, …) calls a function, in
/// a thread of its own, instead of ending the program; another one half a second later ends it at once. To be
/// made before any other thread. After SIGQUIT end_with() leaves a core.
class Interruption {
 public:
  explicit Interruption(std::function<void()> call);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The first signal; 0 if none has come.
  int signal() const { return signal_; }

 private:
  std::atomic<bool> unwanted_{false};
  std::atomic<int> signal_{0};
  sigset_t before_{};
  std::thread thread_;
};

}  // namespace coupler::tools
