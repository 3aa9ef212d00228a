// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <vector>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The order of units that share a connection: writes go before reads, in turn.
enum class Rank {
  read,
  write,  ///< also the read before a write, and the one that verifies it
  safe    ///< before all others, until another rank is set
};

/// Chooses which of the waiting users gets the next turn: writes before reads, each in the order in which
/// they came. While a user claims all turns, no other gets one, also not between two of its requests.
///
/// Writes cannot keep reads waiting for ever: between two reads each user writes once at most. If it has
/// written since the last read, the read that has waited longest goes first. If no read waits, writes are not
/// limited.
class TurnOrder {
 public:
  using Who = const void*;
  /// Makes `who` wait for a turn of this rank, in the place that leave() kept or else at the end. After calls
  /// for two ranks it waits for whichever comes first.
  void come(Who who, Rank rank) {
    const auto kept = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
      return place.who == who && place.rank == rank;
    });
    if (kept != places_.end())
      kept->waits = true;
    else
      places_.push_back({who, rank, true});
  }
  /// `who` no longer waits. The place of a read is kept: it will come again.
  void leave(Who who) {
    for (auto place = places_.begin(); place != places_.end();) {
      if (place->who == who) place->waits = false;
      place = place->who == who && place->rank != Rank::read ? places_.erase(place) : place + 1;
    }
  }
  /// From now on all turns are for `who`, and for others who have claimed them.
  void claim(Who who) {
    if (!claims(who)) claims_.push_back(who);
  }
  void give_up_claim(Who who) {
    claims_.erase(std::remove(claims_.begin(), claims_.end(), who), claims_.end());
  }
  /// Returns whether `who`, which does not wait, may have the turn.
  bool is_free_for(Who who) const { return next() == nullptr && (claims_.empty() || claims(who)); }
  /// Null if nobody waits, or if all turns are claimed by others than those that wait.
  Who next() const {
    const auto place = next_place();
    return place == places_.end() ? nullptr : place->who;
  }
  /// Notes that `who` writes. Until the next read that counts against its other writes.
  void count_write(Who who) {
    if (!has_written(who)) wrote_.push_back(who);
  }
  /// Gives the turn to the next one, for the rank that is returned; it no longer waits.
  Rank serve() {
    const auto place = next_place();
    const auto [who, rank, waits] = *place;
    if (rank == Rank::read)
      wrote_.clear();
    else
      count_write(who);
    places_.erase(place);
    leave(who);
    return rank;
  }

 private:
  struct Place {
    Who who;
    Rank rank;
    bool waits;
  };

  using Places = std::vector<Place>;

  Places::const_iterator next_place() const {
    auto read = places_.end();
    auto write = places_.end();
    for (auto place = places_.begin(); place != places_.end(); ++place) {
      if (!place->waits || !(claims_.empty() || claims(place->who))) continue;
      if (place->rank != Rank::read && !(claims_.empty() && has_written(place->who))) return place;
      auto& first = place->rank == Rank::read ? read : write;
      if (first == places_.end()) first = place;
    }
    return read != places_.end() ? read : write;
  }
  bool claims(Who who) const { return std::find(claims_.begin(), claims_.end(), who) != claims_.end(); }
  bool has_written(Who who) const { return std::find(wrote_.begin(), wrote_.end(), who) != wrote_.end(); }

  Places places_;  ///< in the order of coming
  std::vector<Who> claims_;
  std::vector<Who> wrote_;  ///< since the last read
};

/// A lock that is given in a TurnOrder. Unlike a mutex it may be taken in one thread and released in another,
/// and waiting for it can be ended.
class Turns {
 public:
  using Who = TurnOrder::Who;

  /// Waits for a turn of one of these ranks, and returns its rank; nullopt if none came before `until`. If it
  /// must wait, it calls `give_up()` at once and after each change, and returns nullopt if that is true.
  template <class GiveUp>
  std::optional<Rank> take(Who who, std::initializer_list<Rank> ranks, Time until, GiveUp give_up) {
    std::unique_lock lock(mutex_);
    for (const Rank rank : ranks) order_.come(who, rank);
    const auto is_next = [&] { return holder_ == nullptr && order_.next() == who; };
    bool is_mine = is_next();
    if (!is_mine)
      changed_.wait_until(lock, until, [&] {
        const bool ends = give_up();
        is_mine = !ends && is_next();
        return ends || is_mine;
      });
    if (is_mine) {
      holder_ = who;
      return order_.serve();
    }
    order_.leave(who);
    changed_.notify_all();  // another may be the next now
    return std::nullopt;
  }
  /// TurnOrder::claim(), and its end.
  void claim(Who who, bool claims) {
    const std::lock_guard lock(mutex_);
    if (claims)
      order_.claim(who);
    else
      order_.give_up_claim(who);
    changed_.notify_all();
  }
  /// Takes the turn if nobody has it or waits for it.
  bool try_take(Who who) {
    const std::lock_guard lock(mutex_);
    if (holder_ != nullptr || !order_.is_free_for(who)) return false;
    holder_ = who;
    return true;
  }
  /// TurnOrder::count_write()
  void count_write(Who who) {
    const std::lock_guard lock(mutex_);
    order_.count_write(who);
  }
  void release() {
    const std::lock_guard lock(mutex_);
    holder_ = nullptr;
    changed_.notify_all();
  }
  /// All that wait call give_up() again.
  void look_again() {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }
  bool is_held_by(Who who) const {
    const std::lock_guard lock(mutex_);
    return holder_ == who;
  }
  /// Returns whether somebody waits for a turn.
  bool is_awaited() const {
    const std::lock_guard lock(mutex_);
    return order_.next() != nullptr;
  }
  /// look_again(), and calls `end` if `who` has the turn.
  template <class End>
  void interrupt(Who who, End end) {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
    if (holder_ == who) end();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Who holder_ = nullptr;
  TurnOrder order_;
};

}  // namespace coupler::host
