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

/// The writes that wait to be sent: first those to points of `priority: high`, then the others. What follows
/// holds in each of these two classes by itself. All writes to a point are in its class, whoever makes them,
/// so that an older value never comes after a newer one.
///
/// A *number* has one waiting place. A newer value takes it, or goes to the end if an ordered write has been
/// queued meanwhile: a number never overtakes an ordered write that was made before it.
///
/// *Ordered* are coils, bits and texts, points with `write_queue: every`, and Write::ordered. Each has a
/// place of its own and they keep their order; but a value that equals the newest one of its point that waits
/// joins that one.
///
/// The lock is never held across a request, so that push() never waits for one. The queue allocates only
/// while it grows.
class WriteQueue {
 public:
  static constexpr std::size_t capacity = 1024;  ///< of ordered writes of a class

  /// The map must outlive the queue.
  explicit WriteQueue(const Map& map);

  struct Pushed {
    bool accepted = true;               ///< false: the queue is full, the write is not in it
    std::optional<Write> superseded{};  ///< is no longer in it
  };
  Pushed push(const Write& write);

  /// Moves the first write, and those of its class behind it that go into the same request, to the empty
  /// `batch`; only the first if not `merge`; none that needs a read before, if not `may_read`.
  void take(WriteBatch& batch, bool merge = true, bool may_read = true);
  std::optional<Write> take();
  /// Takes the first write to one of the points (by index, as long as the map's).
  std::optional<Write> take_one_of(const std::vector<bool>& points);
  /// Takes the first write that has waited longer than it may.
  std::optional<Write> take_late(Time now);
  /// Puts writes that were taken and not sent back to the front of their class, in their order.
  void put_back(const std::vector<Write>& writes);
  bool empty() const { return size_now_.load(std::memory_order_relaxed) == 0; }

  /// A write from take() has its result.
  void settled(std::uint32_t point);
  /// A value of the point was pushed and has no result yet.
  bool is_pending(std::uint32_t point) const;
  bool any_pending() const { return pending_writes_.load() != 0; }
  /// How many writes of the point have taken a place so far; for has_results().
  std::uint32_t queued(std::uint32_t point) const;
  /// So many of them, the oldest ones, have their results, however many have come since.
  bool has_results(std::uint32_t point, std::uint32_t queued) const;

 private:
  using Index = std::uint32_t;
  static constexpr Index none = std::numeric_limits<Index>::max();

  struct Place {
    Write write;
    bool ordered;
    std::uint64_t number;  ///< counts what was queued
    Index before;
    Index behind;
  };
  /// Of a point: its waiting writes that a newer one may replace.
  struct Waiting {
    Index number = none;   ///< the place of a number
    Index ordered = none;  ///< the newest ordered one
    std::uint16_t pending = 0;
    std::uint32_t settled = 0;  ///< were pending; it wraps
  };

  /// A class: the writes of one priority, as a list through their places.
  struct Class {
    Index first = none;
    Index last = none;
    std::size_t ordered = 0;         ///< how many
    std::uint64_t last_ordered = 0;  ///< Place::number of the last that was queued
  };

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
  std::atomic<std::size_t> size_now_{0};  ///< without the lock
  std::atomic<bool> any_may_be_late_{false};
};

}  // namespace coupler::host
