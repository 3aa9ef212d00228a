// SPDX-License-Identifier: Apache-2.0
#include "host/core/write_queue.hpp"

#include <algorithm>
#include <utility>

namespace coupler::driver {

bool WriteQueue::replaces_last(const Write& write) {
  if (size_ == 0) return false;
  const Write& last = at(size_ - 1);
  return last.point == write.point && !last.alone && !write.alone &&
         map_.points[write.point].host.write_queue != HostOptions::WriteQueue::every;
}

WriteQueue::Pushed WriteQueue::push(const Write& write) {
  const std::lock_guard lock(mutex_);
  if (replaces_last(write)) return {true, std::exchange(at(size_ - 1), write)};
  if (size_ >= capacity) return {false, {}};
  if (size_ == ring_.size()) grow();
  at(size_) = write;
  size_now_ = ++size_;
  ++pending_[write.point];
  ++pending_writes_;
  return {};
}

void WriteQueue::take(WriteBatch& batch, bool merge) {
  const std::lock_guard lock(mutex_);
  while (size_ > 0 && (merge || batch.empty()) && batch.add(at(0))) pop();
}

std::optional<Write> WriteQueue::take() {
  const std::lock_guard lock(mutex_);
  if (size_ == 0) return std::nullopt;
  const Write first = at(0);
  pop();
  return first;
}

void WriteQueue::settled(std::uint32_t point) {
  const std::lock_guard lock(mutex_);
  --pending_[point];
  --pending_writes_;
}

bool WriteQueue::is_pending(std::uint32_t point) const {
  const std::lock_guard lock(mutex_);
  return pending_[point] != 0;
}

void WriteQueue::grow() {
  std::vector<Write> larger(std::min(capacity, std::max<std::size_t>(8, 2 * ring_.size())));
  for (std::size_t i = 0; i < size_; ++i) larger[i] = at(i);
  ring_ = std::move(larger);
  begin_ = 0;
}

void WriteQueue::pop() {
  begin_ = (begin_ + 1) % ring_.size();
  size_now_ = --size_;
}

}  // namespace coupler::driver
