// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/tls/tls_connection.hpp"

#include <poll.h>

#include <array>
#include <utility>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/net/client_address.hpp"
#include "coupler/tls/alert.hpp"

namespace coupler::device {
namespace {

std::uint32_t epoll_events(short wanted) {
  return ((wanted & POLLIN) != 0 ? EPOLLIN : 0U) | ((wanted & POLLOUT) != 0 ? EPOLLOUT : 0U);
}

/// RFC 8446 6, "protocol_version", fatal: OpenSSL says nothing to a client that does not speak TLS, which
/// would see the connection end and not know why.
constexpr std::array<std::uint8_t, 7> wrong_port{0x15, 3, 3, 0, 2, 2, 70};

tls::Verification of_a_client() {
  tls::Verification verification;
  verification.wants_role = true;
  return verification;
}

}  // namespace

TlsConnection::TlsConnection(Loop& loop, Observer& observer, const tls::Context& context, Descriptor socket,
                             const sockaddr_storage& address, TimePoint now)
    : loop_(loop),
      observer_(observer),
      socket_(std::move(socket)),
      address_(address),
      origin_(origin_of(address)),
      deadline_(now + handshake_timeout),
      session_(context, socket_.get(), of_a_client()) {
  socket_events_.fd = socket_.get();
  watch_all(now);
}

TlsConnection::~TlsConnection() { close(); }

void TlsConnection::ready(TimePoint now) {
  if (state_ == State::draining) return drain();
  go_on(now);
}

void TlsConnection::go_on(TimePoint now) {
  if (state_ == State::handshake && session_.shake_hands() == tls::Session::State::open) open(now);
  if (state_ == State::open) session_.pump();
  const bool goes_on = state_ == State::handshake || state_ == State::open;
  if (goes_on && session_.state() == tls::Session::State::ended) return end(now);
  if (goes_on) watch_all(now);
}

void TlsConnection::open(TimePoint now) {
  deadline_ = TimePoint::max();
  plain_ = observer_.admit(*this);
  if (!plain_.is_open()) return end(now);
  state_ = State::open;
  plain_events_.fd = plain_.get();
  session_.carry(plain_.get());
}

/// Ends the connection. Data that the client has sent meanwhile must not make the kernel throw away what the
/// client has not read yet: an alert, or the last reply.
void TlsConnection::end(TimePoint now) {
  if (!session_.problem().empty()) observer_.failed(*this, session_.problem());
  watch(plain_events_, 0);
  plain_.close();
  if (session_.problem() == tls::no_tls)
    (void)::send(socket_.get(), wrong_port.data(), wrong_port.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  ::shutdown(socket_.get(), SHUT_WR);
  state_ = State::draining;
  deadline_ = now + drain_timeout;
  watch(socket_events_, POLLIN);
  drain();
}

void TlsConnection::drain() {
  std::array<char, 1024> nothing{};
  const ssize_t size = ::recv(socket_.get(), nothing.data(), nothing.size(), MSG_DONTWAIT);
  if (size == 0 || (size < 0 && !would_block())) close();
}

void TlsConnection::tick(TimePoint now) {
  if (now < deadline_) return;
  if (state_ == State::handshake) observer_.failed(*this, "its handshake took too long");
  close();
}

void TlsConnection::close() {
  watch(plain_events_, 0);
  watch(socket_events_, 0);
  plain_.close();
  socket_.close();
  state_ = State::ended;
}

void TlsConnection::watch(Watched& watched, short wanted) {
  const std::uint32_t events = epoll_events(wanted);
  if (events == watched.events) return;
  if (events == 0)
    loop_.forget(watched.fd, *this);
  else if (watched.events != 0)
    loop_.change(watched.fd, static_cast<Interest>(events), *this);
  else if (!loop_.watch(watched.fd, static_cast<Interest>(events), *this))
    is_unwatched_ = true;
  watched.events = events;
}

void TlsConnection::watch_all(TimePoint now) {
  const tls::Session::Wants wants = session_.wants();
  watch(socket_events_, wants.socket);
  watch(plain_events_, wants.plain);
  const bool waits = state_ == State::open && (wants.socket & POLLOUT) != 0;
  const bool has_taken = std::exchange(sent_, session_.sent()) != session_.sent();
  // Once nothing more comes it has no more time for the rest, however slowly it takes it.
  if (waits && (!waits_for_client_ || (has_taken && !session_.is_ending()))) deadline_ = now + write_timeout;
  if (!waits && state_ == State::open) deadline_ = TimePoint::max();
  waits_for_client_ = waits;
  if (is_unwatched_) deadline_ = TimePoint{};  // the kernel has no memory for it: it ends at the next tick()
}

}  // namespace coupler::device
