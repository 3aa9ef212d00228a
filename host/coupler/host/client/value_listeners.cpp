// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/value_listeners.hpp"

#include <utility>

namespace coupler::client {

void ValueListeners::call(std::uint32_t point, const std::uint16_t* registers, host::Stamp stamp) {
  std::unique_lock lock(mutex_);
  auto listener = listeners_[point];
  if (!listener) return;
  called_ = point;
  ++calls_;
  caller_ = std::this_thread::get_id();
  lock.unlock();
  (*listener)(registers, stamp);
  listener.reset();  // a listener that was replaced is destroyed before set() returns
  lock.lock();
  called_.reset();
  returned_.notify_all();
}

void ValueListeners::set(std::uint32_t point, Listener listener) {
  auto shared = listener ? std::make_shared<const Listener>(std::move(listener)) : nullptr;
  std::unique_lock lock(mutex_);
  shared.swap(listeners_[point]);
  if (called_ != point || caller_ == std::this_thread::get_id()) return;
  returned_.wait(lock, [this, call = calls_] { return !called_ || calls_ != call; });
}

}  // namespace coupler::client
