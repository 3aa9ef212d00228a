// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/connection.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cassert>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/descriptor.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/device/net/client_address.hpp"
#include "coupler/device/net/client_socket.hpp"

namespace coupler::device {
namespace {

using Outcome = modbus::Framer::Outcome;

}  // namespace

void Connection::open(Descriptor socket, const IpAddress& origin, TimePoint now) {
  assert(!is_open());
  framer_.reset();
  output_begin_ = output_end_ = 0;
  ended_ = has_asked_ = is_probed_ = false;
  session_ = {};
  tls_.reset();
  origin_ = origin;
  last_active_ = now;
  waiting_ = Waiting::for_request;
  deadline_.reset();
  if (loop_.watch(socket.get(), Interest::read, *this)) socket_ = std::move(socket);
}

void Connection::open(OpenConnection from, const IpAddress& origin, TimePoint now) {
  assert(from.unread.size() <= longest_unread && from.unsent.size() <= output_size);
  open(std::move(from.socket), origin, now);
  if (!is_open()) return;
  tls_ = from.tls;
  session_.is_plain = !tls_;
  if (tls_) session_.role = server_.role_of(tls_->role.view());
  // A client that may no longer write anything no longer feeds the watchdog.
  session_.has_written = from.has_written && server_.may_write(session_);
  has_asked_ = from.has_asked;
  std::copy(from.unread.begin(), from.unread.end(), framer_.room().begin());
  framer_.filled(from.unread.size());
  std::copy(from.unsent.begin(), from.unsent.end(), output_.begin());
  output_end_ = from.unsent.size();
  // Whole frames may be waiting, of which the socket does not tell any more.
  if (has_output()) loop_.change(socket_.get(), Interest::write, *this);
  ready(now);
}

std::string Connection::who() const {
  if (!tls_) return host_of(peer_of(socket_.get()).value_or(sockaddr_storage{}));
  // They come from the process that does TLS, which has judged them; but it may be under somebody's control.
  const auto shown = [](const ShortText& text) {
    return codec::is_plain_text(text.view()) ? text.view() : "?";
  };
  const std::string_view role = tls_->role.view().empty() ? "no role" : shown(tls_->role);
  return fmt::format("'{}' ({}, {})", shown(tls_->name), host_of(tls_->address), role);
}

OpenConnection Connection::release() {
  OpenConnection open;
  end_wait();
  loop_.forget(socket_.get(), *this);
  open.socket = std::move(socket_);
  open.has_asked = has_asked_;
  open.has_written = session_.has_written;
  open.tls = tls_;
  const modbus::Bytes rest = framer_.rest();
  open.unread.assign(rest.begin(), rest.end());
  open.unsent.assign(&output_[output_begin_], &output_[output_begin_] + (output_end_ - output_begin_));
  deadline_.reset();
  return open;
}

/// There is room: nothing came behind the request that waits.
void Connection::end_wait() {
  unlist();
  put_waiting();
  (void)send();  // what the client does not take now stays
}

void Connection::close() {
  if (!is_open()) return;
  unlist();
  loop_.forget(socket_.get(), *this);
  socket_.close();
  deadline_.reset();
  server_.end_session(session_, TimePoint::clock::now());
}

void Connection::have_turn(TimePoint now, Receives receives) {
  const bool was_sending = has_output();
  const TimePoint before = last_active_;
  if (!take_turn(now, receives)) return close();
  if (has_output() != was_sending)
    loop_.change(socket_.get(), has_output() ? Interest::write : Interest::read, *this);
  list();
  set_deadline(now, last_active_ != before);
}

/// Tells the waiters whether this is one of them. While the client does not read, what it waits for waits,
/// too.
void Connection::list() {
  const bool waits = session_.wait && !has_output();
  const auto until = waits ? std::optional(session_.wait->until) : std::nullopt;
  if (until == listed_) return;
  unlist();
  if (until) waiters_.add(*this, *until);
  listed_ = until;
}

void Connection::unlist() {
  if (std::exchange(listed_, std::nullopt)) waiters_.remove(*this);
}

/// False: the connection is to be closed.
bool Connection::take_turn(TimePoint now, Receives receives) {
  // First what an earlier turn left: replies, and requests behind them.
  if (!send() || !answer(now)) return false;
  if (has_output()) return true;
  if (receives == Receives::no) return !ended_;
  if (!ended_ && !receive()) return false;
  // The bytes that have just been received came after `now`, and clients derive times from that.
  return answer(TimePoint::clock::now()) && (!ended_ || has_output());
}

bool Connection::receive() {
  const auto room = framer_.room();
  // Another process can make a socket wait that it has handed over.
  const ssize_t size = ::recv(socket_.get(), room.data(), room.size(), MSG_DONTWAIT);
  if (size < 0) return would_block();
  if (size == 0) ended_ = true;
  framer_.filled(static_cast<std::size_t>(size));
  return true;
}

/// Answers whole frames for as long as the client takes the replies.
bool Connection::answer(TimePoint now) {
  while (!has_output()) {
    const Outcome outcome = fill_output(now);
    if (!send()) return false;
    if (outcome == Outcome::nothing) return true;
    if (outcome == Outcome::frame) continue;
    if (is_away_) return false;
    ++statistics_.bad_frames;
    tell_of_tls();
    return false;
  }
  return true;
}

/// A client that speaks TLS here has the wrong port, and cannot say so itself.
void Connection::tell_of_tls() {
  const modbus::Bytes said = framer_.rest();
  constexpr std::uint8_t handshake = 0x16;  // RFC 8446, 5.1: type, then a version 3.x
  if (said.size() > 2 && said[0] == handshake && said[1] == 3)
    log_.warn_limited("TLS", fmt::format("{} speaks TLS at the port without it; TLS has the port that "
                                         "'security' says, usually 802",
                                         who()));
}

/// Answers whole frames while there is room for the longest reply; tells what comes next.
Outcome Connection::fill_output(TimePoint now) {
  while (has_room()) {
    if (session_.wait && server_.is_due(session_, now)) put_waiting();
    const Outcome outcome = framer_.next();
    if (outcome == Outcome::nothing && ended_) put_waiting();
    if (outcome != Outcome::frame) return outcome;
    is_away_ = !server_.answers();
    if (is_away_) return Outcome::bad;
    if (framer_.frame().pdu[0] == static_cast<std::uint8_t>(modbus::Function::schedule_output)) be_probed();
    output_end_ += server_.answer(framer_.frame(), session_, now, room());
    has_asked_ = true;
    last_active_ = now;
  }
  return Outcome::frame;
}

/// Scheduled outputs are cancelled when their connection ends, and a pulled cable does not show that. With
/// TLS the other process has the client's socket, and probes every client.
void Connection::be_probed() {
  if (!std::exchange(is_probed_, true)) notice_end_soon(socket_.get());
}

/// The reply to what it waits for has the time at which it leaves.
void Connection::put_waiting() { output_end_ += server_.end_wait(session_, TimePoint::clock::now(), room()); }

/// Returns whether there is room for the longest reply, and for the reply to the wait.
bool Connection::has_room() const {
  return output_.size() - output_end_ >= (session_.wait ? 2 : 1) * modbus::max_adu_size;
}

bool Connection::send() {
  while (has_output()) {
    const ssize_t size = ::send(socket_.get(), &output_[output_begin_], output_end_ - output_begin_,
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size < 0) return would_block();
    output_begin_ += static_cast<std::size_t>(size);
  }
  output_begin_ = output_end_ = 0;
  return true;
}

void Connection::set_deadline(TimePoint now, bool had_frame) {
  const Waiting waiting = has_output()           ? Waiting::for_client_to_read
                          : framer_.is_partial() ? Waiting::for_rest_of_frame
                                                 : Waiting::for_request;
  if (waiting == Waiting::for_request)
    deadline_.reset();
  else if (waiting != waiting_ || had_frame)
    deadline_ = now + timeout;
  waiting_ = waiting;
}

}  // namespace coupler::device
