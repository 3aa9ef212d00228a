// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/step_thread.hpp"

#include <exception>

namespace coupler::host {

void StepThread::start() {
  thread_ = std::thread([this] { run(); });
}

void StepThread::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_one();
}

void StepThread::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool StepThread::has_ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void StepThread::run() {
  Time next = Time::max();
  std::unique_lock lock(mutex_);
  for (bool is_last = false; !is_last;) {
    const auto is_due = [this] { return woken_ || ended_; };
    if (next == Time::max())
      changed_.wait(lock, is_due);
    else
      changed_.wait_until(lock, next, is_due);
    woken_ = false;
    is_last = ended_;
    lock.unlock();
    try {
      next = step_(std::chrono::steady_clock::now());
    } catch (...) {
      std::terminate();  // from here, so that the locks are free with which the outputs are made safe
    }
    lock.lock();
  }
}

}  // namespace coupler::host
