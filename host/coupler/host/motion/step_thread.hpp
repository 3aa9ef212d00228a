// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// A thread that calls step(now) when it is woken, and at the time that the previous call returned.
class StepThread {
 public:
  /// Call start() when everything that `step` uses is there.
  explicit StepThread(std::function<Time(Time now)> step) : step_(std::move(step)) {}
  ~StepThread() { end(); }
  StepThread(const StepThread&) = delete;
  StepThread& operator=(const StepThread&) = delete;

  void start();
  /// Makes the thread call step() soon. Any thread may call it, also before start(); it waits for nothing.
  void wake();
  /// Ends the thread after one more call of step().
  void end();
  bool has_ended();

 private:
  void run();

  const std::function<Time(Time)> step_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace coupler::host
