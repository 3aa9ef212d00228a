// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <initializer_list>
#include <mutex>
#include <optional>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/modbus/turn_order.hpp"

namespace coupler::host {

/// Who may use what several share, in a TurnOrder. Unlike a mutex it may be taken in one thread and released
/// in another, and waiting for it can be ended.
class Turns {
 public:
  using Who = TurnOrder::Who;

  /// Waits for a turn of one of these ranks, and returns which it is. None if none has come until `until`, or
  /// if `give_up()` was true, which is asked at first and after each look_again().
  template <class GiveUp>
  std::optional<Rank> take(Who who, std::initializer_list<Rank> ranks, Time until, GiveUp give_up) {
    std::unique_lock lock(mutex_);
    for (const Rank rank : ranks) order_.come(who, rank);
    bool is_mine = false;
    changed_.wait_until(lock, until, [&] {
      const bool ends = give_up();
      is_mine = !ends && holder_ == nullptr && order_.next() == who;
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
  /// Takes it if nobody has it or waits for it.
  bool try_take(Who who) {
    const std::lock_guard lock(mutex_);
    if (holder_ != nullptr || !order_.is_free_for(who)) return false;
    holder_ = who;
    return true;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    holder_ = nullptr;
    changed_.notify_all();
  }
  /// Who waits asks again whether to give up.
  void look_again() {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }
  /// look_again(); if it is `who`'s turn, `end` is called to cut it short.
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
  TurnOrder order_;
};

}  // namespace coupler::host
