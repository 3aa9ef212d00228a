// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "coupler/host/core/write_batch.hpp"

namespace coupler::host {

/// The writes that wait to be sent: first those to points with `priority: high`, then the others. The rules
/// below hold for each of these two classes. All writes to a point are in the class of the point, so that an
/// older value is never sent after a newer one.
///
/// A *number* has one place in the queue. A newer value replaces the older one, at the end of the queue if an
/// ordered write has been queued in between: a number never overtakes an older ordered write.
///
/// Writes to coils, bits, texts and points with `write_queue: every`, and those with Write::ordered, are
/// *ordered*. Each has a place of its own, and they keep their order. A value that equals the newest queued
/// value of its point joins it.
///
/// The lock is never held during a request, so push() never waits for one. The queue allocates memory only
/// while it grows.
class WriteQueue {
 public:
  static constexpr std::size_t capacity = 1024;  ///< the limit of ordered writes in a class

  /// The map must outlive the queue.
  explicit WriteQueue(const Map& map);

  struct Pushed {
    bool accepted = true;               ///< false: the queue is full, and the write is not in it
    std::optional<Write> superseded{};  ///< the write that is no longer in the queue
  };
  Pushed push(const Write& write);
  /// Adds ordered writes with none between those of one class. Returns false if there is no room for all of
  /// them; then none is in the queue.
  bool push_together(Span<const Write> writes);

  /// Moves the first write, and those behind it in its class that fit into the same request, to the empty
  /// `batch`. Without `merge` it moves only the first, and without `may_read` none that needs a read before.
  void take(WriteBatch& batch, bool merge = true, bool may_read = true);
  std::optional<Write> take();
  /// Takes the first write to one of the points. `points` has an element for each point of the map.
  std::optional<Write> take_one_of(const std::vector<bool>& points);
  /// Takes the first write that has waited longer than it may.
  std::optional<Write> take_late(Time now);
  /// Takes the write whose result the listener would receive.
  std::optional<Write> take_of(const WriteListener& listener);
  /// Puts writes that were taken but not sent back to the front of their class, in their order.
  void put_back(const std::vector<Write>& writes);
  bool empty() const { return size_now_.load(std::memory_order_relaxed) == 0; }

  /// Notes that a write from take() has its result.
  void settled(std::uint32_t point);
  /// Returns whether a value of the point was pushed and has no result yet.
  bool is_pending(std::uint32_t point) const;
  bool any_pending() const { return pending_writes_.load() != 0; }
  /// Returns how many writes to the point have taken a place so far, for has_results().
  std::uint32_t queued(std::uint32_t point) const;
  /// Returns whether the oldest so many of them have their results.
  bool has_results(std::uint32_t point, std::uint32_t queued) const;

 private:
  using Index = std::uint32_t;
  static constexpr Index none = std::numeric_limits<Index>::max();

  struct Place {
    Write write;
    bool ordered;
    std::uint64_t number;  ///< the number of the write among all that were queued
    Index before;
    Index behind;
  };
  /// The queued writes to a point that a newer one may replace.
  struct Waiting {
    Index number = none;   ///< the place of the number
    Index ordered = none;  ///< the place of the newest ordered write
    std::uint16_t pending = 0;
    std::uint32_t settled = 0;  ///< writes that have their results; the count wraps
  };

  /// The writes of one class, as a linked list.
  struct Class {
    Index first = none;
    Index last = none;
    std::size_t ordered = 0;         ///< their number
    std::uint64_t last_ordered = 0;  ///< Place::number of the newest one
  };

  /// Takes the first write for which `which(write)` is true.
  template <class Which>
  std::optional<Write> take_if(Which which);
  Pushed push_locked(const Write& write);
  void settle(Waiting& waiting);
  bool is_ordered(const Write& write) const;
  bool joins(const Write& newer, const Write& older) const;
  Class& class_of(const Write& write);
  Index first() const { return high_.first != none ? high_.first : normal_.first; }
  Index next(Index place) const;
  Index insert(const Write& write, bool ordered, Index behind);
  Write remove(Index place);

  const Map& map_;
  mutable std::mutex mutex_;
  std::vector<Place> places_;
  std::vector<Index> free_;
  Class high_;
  Class normal_;
  std::uint64_t numbered_ = 0;
  std::vector<Waiting> waiting_;  ///< by point
  std::atomic<std::size_t> pending_writes_{0};
  std::atomic<std::size_t> size_now_{0};  ///< read without the lock
  std::atomic<bool> any_may_be_late_{false};
};

}  // namespace coupler::host
