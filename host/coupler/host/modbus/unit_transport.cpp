// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/unit_transport.hpp"

#include <algorithm>
#include <utility>

namespace coupler::host {
namespace {

tl::unexpected<Error> interrupted_error() { return fail(NotConnected{"interrupted"}); }
tl::unexpected<Error> lost_error() {
  return fail(TransportFailure{
      "the gateway has closed the connection, or cannot be reached; or the serial port has gone"});
}

}  // namespace

UnitTransport::UnitTransport(std::shared_ptr<SharedConnection> shared, const Connection& unit,
                             const Limits& limits)
    : shared_(std::move(shared)),
      unit_(unit.unit),
      timeout_(unit.timeout),
      gap_(limits.request_gap),
      delay_(limits.connect_delay) {}

Result<> UnitTransport::take(Rank rank) {
  if (std::exchange(has_turn_, false)) return {};
  const auto give_up = [this] { return interrupted_.is_set() || is_lost(); };
  if (shared_->turns.take(this, {rank}, Time::max(), give_up)) return {};
  return interrupted_.is_set() ? interrupted_error() : lost_error();
}

void UnitTransport::rank(Rank rank) {
  const Rank before = std::exchange(rank_, rank);
  if ((before == Rank::safe) != (rank == Rank::safe)) shared_->turns.claim(this, rank == Rank::safe);
}

void UnitTransport::release() {
  if (shared_->users == 0) {
    shared_->transport->close();
    shared_->open = false;
  }
  shared_->turns.release();
}

Result<> UnitTransport::open() {
  shared_->transport->close();
  const Time begun = std::chrono::steady_clock::now();
  Result<> opened = shared_->transport->open(interrupted_);
  shared_->open = opened.has_value();
  shared_->opened = std::chrono::steady_clock::now();
  // Each of the others would wait as long for nothing.
  if (!opened && shared_->opened - begun >= timeout_) ++shared_->ended;
  return opened;
}

Result<> UnitTransport::connect() {
  close();
  wait_until_past(late_until_);
  if (auto taken = take(Rank::read); !taken) return taken;
  Result<> result = shared_->transport->select(unit_, timeout_);
  if (result && !shared_->open) result = open();
  if (result) {
    connected_ = true;
    ended_ = shared_->ended;
    ++shared_->users;
  }
  release();
  return result;
}

void UnitTransport::close() {
  if (std::exchange(in_flight_, false)) {
    unanswered();
    release();
  }
  give_back();
  if (!std::exchange(connected_, false) || --shared_->users > 0) return;
  // It does not wait for its turn: a lost unit is to be reported at once. If another unit has the turn, that
  // one goes on with the connection, or closes it.
  if (shared_->turns.try_take(this)) release();
}

void UnitTransport::wake() {
  woken_ = true;
  wakeup_.call();
  shared_->turns.look_again();
}

void UnitTransport::interrupt() {
  interrupted_.set();
  shared_->turns.interrupt(this, [this] { shared_->transport->hang_up(); });
}

Time UnitTransport::ready() const { return std::max(shared_->opened + delay_, shared_->answered + gap_); }

/// Or until it is interrupted.
void UnitTransport::wait_until_past(Time time) {
  if (time <= std::chrono::steady_clock::now()) return;
  Wakeup nobody;
  wait_for(nobody, interrupted_, -1, time);
}

/// Makes the connection ready for a request, in its turn.
Result<> UnitTransport::prepare() {
  if (!connected_) return fail(NotConnected{"not connected"});
  if (is_lost()) return lost_error();
  if (auto selected = shared_->transport->select(unit_, timeout_); !selected) return selected;
  if (!shared_->open)
    if (auto opened = open(); !opened) return opened;
  wait_until_past(ready());
  if (interrupted_.is_set()) return interrupted_error();
  return {};
}

/// The answer may still come, and would be taken for that to another request.
void UnitTransport::unanswered() {
  if (shared_->transport->is_bus()) {
    late_until_ = std::chrono::steady_clock::now() + timeout_;
    return;
  }
  shared_->transport->close();
  shared_->open = false;
}

/// The request of this turn has ended.
void UnitTransport::done(const Error* error) {
  shared_->answered = std::chrono::steady_clock::now();
  if (error != nullptr && exception_in(*error) != nullptr) error = nullptr;
  const bool is_lost = error != nullptr && std::holds_alternative<TransportFailure>(*error);
  if (error != nullptr && !is_lost) unanswered();
  if (is_lost) {
    shared_->transport->close();
    shared_->open = false;
    if (!interrupted_.is_set()) ++shared_->ended;
  }
  release();
}

Result<modbus::Bytes> UnitTransport::done(const Result<modbus::Bytes>& reply) {
  if (reply) std::copy(reply->begin(), reply->end(), reply_.begin());
  const std::size_t size = reply ? reply->size() : 0;
  done(reply ? nullptr : &reply.error());
  if (!reply) return reply;
  return modbus::Bytes(reply_).first(size);
}

Result<> UnitTransport::begin(Rank rank) {
  if (auto taken = take(rank); !taken) return taken;
  Result<> prepared = prepare();
  if (!prepared) release();
  return prepared;
}

Result<modbus::Bytes> UnitTransport::exchange(modbus::Bytes pdu) {
  if (auto begun = begin(rank_); !begun) return tl::make_unexpected(begun.error());
  return done(shared_->transport->exchange(pdu));
}

Transport::Turn UnitTransport::await_turn(Time until, bool write_waits) {
  if (has_turn_) return Turn::read;
  const auto give_up = [this] { return woken_.exchange(false) || interrupted_.is_set() || is_lost(); };
  const auto turn = write_waits ? shared_->turns.take(this, {Rank::read, Rank::write}, until, give_up)
                                : shared_->turns.take(this, {Rank::read}, until, give_up);
  has_turn_ = turn.has_value();
  if (turn) return *turn == Rank::read ? Turn::read : Turn::write;
  return interrupted_.is_set() || is_lost() ? Turn::read : Turn::none;  // the read fails, with the reason
}

void UnitTransport::await_turn_to_write(const std::function<bool()>& ends) {
  if (has_turn_) return;
  const auto give_up = [&] { return ends() || interrupted_.is_set() || is_lost(); };
  has_turn_ = shared_->turns.take(this, {Rank::write}, Time::max(), give_up).has_value();
}

bool UnitTransport::reserve() {
  if (!shared_->turns.try_take(this)) return false;
  has_turn_ = connected_ && !is_lost() && shared_->open && std::chrono::steady_clock::now() >= ready() &&
              shared_->transport->select(unit_, timeout_) && shared_->transport->can_send();
  if (!has_turn_) release();
  reserved_ = has_turn_;
  return has_turn_;
}

void UnitTransport::give_back() {
  reserved_ = false;
  if (std::exchange(has_turn_, false)) release();
}

Result<> UnitTransport::send_pdu(modbus::Bytes pdu) {
  const bool reserved = std::exchange(reserved_, false);
  if (auto begun = begin(Rank::write); !begun) return begun;
  if (auto sent = shared_->transport->send_pdu(pdu); !sent) {
    done(&sent.error());
    return sent;
  }
  in_flight_ = true;
  if (reserved) wake();  // no thread polls a shared socket: the owner must call receive_pdu()
  return {};
}

Result<modbus::Bytes> UnitTransport::receive_pdu() {
  in_flight_ = false;
  return done(shared_->transport->receive_pdu());
}

}  // namespace coupler::host
