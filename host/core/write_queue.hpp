// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "host/core/write_batch.hpp"

namespace coupler::driver {

/// The writes that wait to be sent, in order. Its lock is never held across a request, so that a caller who
/// pushes waits for nobody. It allocates only while it grows.
class WriteQueue {
 public:
  static constexpr std::size_t capacity = 1024;

  /// What `map` views must outlive the queue.
  explicit WriteQueue(const Map& map) : map_(map), pending_(map.points.size(), 0) {}

  struct Pushed {
    bool accepted = true;               ///< false: the queue is full, the write is not in it
    std::optional<Write> superseded{};  ///< the write is in its place
  };
  /// A newer value of the point whose write is last in the queue replaces that one.
  Pushed push(const Write& write);

  /// Moves the first write, and those behind it that go into the same request, to the empty `batch`; only the
  /// first if not `merge`.
  void take(WriteBatch& batch, bool merge = true);
  std::optional<Write> take();
  bool empty() const { return size_now_.load(std::memory_order_relaxed) == 0; }

  /// What take() gave has its result.
  void settled(std::uint32_t point);
  /// A value of the point is on its way: one that was pushed and has no result yet.
  bool is_pending(std::uint32_t point) const;
  bool any_pending() const { return pending_writes_.load() != 0; }

 private:
  Write& at(std::size_t i) { return ring_[(begin_ + i) % ring_.size()]; }
  bool replaces_last(const Write& write);
  void grow();
  void pop();

  Map map_;
  mutable std::mutex mutex_;
  std::vector<Write> ring_;
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
  std::vector<std::uint16_t> pending_;  ///< by point
  std::atomic<std::size_t> pending_writes_{0};
  std::atomic<std::size_t> size_now_{0};  ///< size_, without the lock
};

}  // namespace coupler::driver
