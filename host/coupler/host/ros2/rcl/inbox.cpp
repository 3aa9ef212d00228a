// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/inbox.hpp"

#include <algorithm>

#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {
namespace {

/// How much is taken from one source in a row: a burst delays the others little.
constexpr int turn = 32;

}  // namespace

void Inbox::Source::begin(const std::string& failure) {
  const auto note_of = [](const void* self, std::size_t /*how_many*/) {
    const_cast<Source*>(static_cast<const Source*>(self))->note();
  };
  check(follow_(note_of, this), failure);
}

Inbox::Source::~Source() {
  ignore(follow_(nullptr, nullptr));
  inbox_.remove(*this);
}

void Inbox::add(Source& source) {
  {
    const std::lock_guard lock(mutex_);
    if (ended_ || source.left_) return;
    noted_.push_back(&source);
  }
  changed_.notify_all();
}

void Inbox::remove(Source& source) {
  std::unique_lock lock(mutex_);
  source.left_ = true;  // after a long turn it notes itself once more
  noted_.erase(std::remove(noted_.begin(), noted_.end(), &source), noted_.end());
  if (std::this_thread::get_id() == thread_.get_id()) return;
  changed_.wait(lock, [&] { return current_ != &source; });
}

void Inbox::stop() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    noted_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Inbox::empty(Source& source) {
  source.noted_ = false;  // first: what comes from now on is noted again
  int left = turn;
  while (source.take_())
    if (--left == 0) return source.note();
}

void Inbox::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ended_ || !noted_.empty(); });
    if (ended_) return;
    Source& source = *noted_.front();
    noted_.pop_front();
    current_ = &source;
    lock.unlock();
    empty(source);
    lock.lock();
    current_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace coupler::rcl
