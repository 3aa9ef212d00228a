// SPDX-License-Identifier: Apache-2.0
#include "host/core/write_queue.hpp"

namespace coupler::driver {

bool WriteQueue::push(const Write& write) {
  {
    const std::lock_guard lock(mutex_);
    if (writes_.size() >= capacity) return false;
    writes_.push_back(write);
  }
  changed_.notify_one();
  return true;
}

std::optional<Write> WriteQueue::take() {
  const std::lock_guard lock(mutex_);
  if (writes_.empty()) return std::nullopt;
  const Write write = writes_.front();
  writes_.pop_front();
  return write;
}

void WriteQueue::wait_until(Time time) {
  std::unique_lock lock(mutex_);
  const auto woken = [this] { return stopped_ || !writes_.empty(); };
  if (time == Time::max())
    changed_.wait(lock, woken);
  else
    changed_.wait_until(lock, time, woken);
}

void WriteQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

}  // namespace coupler::driver
