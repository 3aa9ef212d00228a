// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/workers.hpp"

#include <utility>

namespace coupler::host {

Workers::Workers(std::size_t number) {
  threads_.reserve(number);
  try {
    while (threads_.size() < number) threads_.emplace_back([this] { run(); });
  } catch (...) {
    end();
    throw;
  }
}

void Workers::add(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void Workers::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    auto task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    task = nullptr;  // what it held may take its time, too
    lock.lock();
  }
}

void Workers::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
}

}  // namespace coupler::host
