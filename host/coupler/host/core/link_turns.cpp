// SPDX-License-Identifier: Apache-2.0
// A link waits here for its turn on the channel, takes it, and gives it back.
#include <utility>

#include "coupler/host/core/link.hpp"

namespace coupler::host {

Result<> Link::take_turn(Rank rank) {
  if (std::exchange(has_turn_, false)) return {};
  if (shared_->turns.take(this, {rank}, Time::max(), [this] { return must_give_up(); })) return {};
  return give_up_error();
}

tl::unexpected<Error> Link::give_up_error() const {
  if (interrupted_.is_set()) return fail(NotConnected{"interrupted"});
  if (is_polled()) return fail(TransportFailure{"the connection has ended"});
  return fail(TransportFailure{
      "the gateway has closed the connection, or cannot be reached; or the serial port has gone"});
}

void Link::release() {
  if (shared_->users == 0) {
    channel().close();
    shared_->is_open = false;
  }
  shared_->turns.release();
}

void Link::rank(Rank rank) {
  const Rank before = std::exchange(rank_, rank);
  if ((before == Rank::safe) != (rank == Rank::safe)) shared_->turns.claim(this, rank == Rank::safe);
}

Link::Turn Link::await_turn(Time until, bool write_waits) {
  pause_until(ready_);  // before the turn, which others wait for
  if (has_turn_) return Turn::read;
  const auto give_up = [this] { return is_woken_.exchange(false) || must_give_up(); };
  const auto turn = write_waits ? shared_->turns.take(this, {Rank::read, Rank::write}, until, give_up)
                                : shared_->turns.take(this, {Rank::read}, until, give_up);
  has_turn_ = turn.has_value();
  if (turn) return *turn == Rank::read ? Turn::read : Turn::write;
  return must_give_up() ? Turn::read : Turn::none;  // the read fails, with the reason
}

void Link::await_turn_to_write(const std::function<bool()>& ends) {
  pause_until(ready_);
  if (has_turn_) return;
  const auto give_up = [&] { return ends() || must_give_up(); };
  has_turn_ = shared_->turns.take(this, {Rank::write}, Time::max(), give_up).has_value();
}

bool Link::reserve() {
  if (!shared_->turns.try_take(this)) return false;
  has_turn_ = is_connected_ && !is_lost() && shared_->is_open && clock_.now() >= channel_ready() &&
              channel().select(unit_, timeout_) && channel().can_send();
  if (has_turn_)
    shared_->turns.count_write(this);
  else
    release();
  is_reserved_ = has_turn_;
  return has_turn_;
}

void Link::give_back() {
  is_reserved_ = false;
  if (std::exchange(has_turn_, false)) release();
}

Woken Link::wait_until(Time time) {
  const Woken woken = is_polled() ? channel().wait_until(time, wakeup_, interrupted_)
                                  : wait_for(wakeup_, &interrupted_, -1, time);
  is_woken_ = false;  // the caller looks at what there is to do now
  return woken;
}

void Link::wake() {
  is_woken_ = true;
  wakeup_.call();
  shared_->turns.look_again();
}

}  // namespace coupler::host
