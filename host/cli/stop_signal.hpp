// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace coupler::cli {

/// SIGINT and SIGTERM end something in this program, not the program. To be made before other threads are.
class StopSignal {
 public:
  /// `on_stop` is called in a thread of its own, once: when the first has come, or else at the end of this.
  explicit StopSignal(std::function<void()> on_stop);
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool has_come() const { return come_; }

 private:
  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<bool> come_{false};
  std::thread thread_;
};

}  // namespace coupler::cli
