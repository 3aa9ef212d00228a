// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace coupler::cli {

/// While it exists, the first SIGINT (Ctrl-C) or SIGTERM calls a function, in a thread of its own, instead of
/// ending the program. To be made before any other thread.
class Interruption {
 public:
  explicit Interruption(std::function<void()> call);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  std::atomic<bool> unwanted_{false};
  sigset_t before_{};
  std::thread thread_;
};

}  // namespace coupler::cli
