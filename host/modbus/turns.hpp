// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "host/modbus/event.hpp"

namespace coupler::driver {

/// Who may use what several share: first come, first served. Unlike a mutex it may be taken in one thread and
/// released in another, and waiting for it can be ended.
class Turns {
 public:
  using Who = const void*;

  /// Waits for those who came before. False if `interrupted` was set meanwhile.
  bool take(Who who, const Event& interrupted) {
    std::unique_lock lock(mutex_);
    waiting_.push_back(who);
    changed_.wait(lock,
                  [&] { return interrupted.is_set() || (holder_ == nullptr && waiting_.front() == who); });
    waiting_.erase(std::find(waiting_.begin(), waiting_.end(), who));
    if (interrupted.is_set()) {
      changed_.notify_all();  // the next may be the first now
      return false;
    }
    holder_ = who;
    return true;
  }
  /// Takes it if nobody has it or waits for it.
  bool try_take(Who who) {
    const std::lock_guard lock(mutex_);
    if (holder_ != nullptr || !waiting_.empty()) return false;
    holder_ = who;
    return true;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    holder_ = nullptr;
    changed_.notify_all();
  }
  /// After `interrupted` was set: who waits returns; if it is `who`'s turn, `end` is called to cut it short.
  template <class End>
  void interrupt(Who who, End end) {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
    if (holder_ == who) end();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Who holder_ = nullptr;
  std::deque<Who> waiting_;
};

}  // namespace coupler::driver
