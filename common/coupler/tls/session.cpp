// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/session.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <utility>

#include "coupler/base/descriptor.hpp"

namespace coupler::tls {
namespace {

/// So many times in one call; others have a turn after that.
constexpr int most_rounds = 8;

}  // namespace

Session::Session(const Context& context, int socket, Verification verification)
    : stream_(context, socket, std::move(verification)),
      socket_wants_(SSL_is_server(ssl()) != 0 ? POLLIN : POLLOUT) {}

std::optional<std::string> Session::why_refused_by(const Context& context) const {
  return context.why_refused(SSL_get0_peer_certificate(ssl()), SSL_get_peer_cert_chain(ssl()));
}

Session::State Session::shake_hands() {
  socket_wants_ = 0;
  const Stream::Progress shaken = stream_.shake_hands();
  if (shaken.bytes > 0)
    state_ = State::open;
  else if (!is_blocked(shaken))
    state_ = State::ended;
  return state_;
}

Session::State Session::pump() {
  socket_wants_ = 0;
  read_needs_write_ = false;
  for (int round = 0; state_ == State::open && round < most_rounds; ++round) {
    bool moved = take();
    moved = send() || moved;
    moved = receive() || moved;
    moved = hand_over() || moved;
    if (!moved) break;
  }
  if (state_ == State::open && plain_ended_ && to_peer_.empty()) {
    stream_.close();  // what the socket does not take at once is not missed
    state_ = State::ended;
  }
  return state_;
}

Session::Wants Session::wants() const {
  Wants wants{socket_wants_, 0};
  if (state_ != State::open) return wants;
  const bool reads = !peer_ended_ && !read_needs_write_;
  if (to_plain_.empty() && reads) wants.socket |= POLLIN;
  if (to_peer_.empty() && !plain_ended_) wants.plain |= POLLIN;
  // poll() does not report bytes that OpenSSL has already decrypted.
  if (!to_plain_.empty() || (reads && stream_.has_pending())) wants.plain |= POLLOUT;
  return wants;
}

/// From the peer.
bool Session::receive() {
  if (state_ != State::open || !to_plain_.empty() || peer_ended_) return false;
  const Stream::Progress got = stream_.read(to_plain_.bytes.data(), to_plain_.bytes.size());
  if (got.bytes > 0) {
    to_plain_.begin = 0;
    to_plain_.end = static_cast<std::size_t>(got.bytes);
    return true;
  }
  if (is_blocked(got))
    read_needs_write_ = got.wants == POLLOUT;
  else if (stream_.has_failed())
    state_ = State::ended;
  else
    peer_ended_ = true;
  return false;
}

/// To the plain side.
bool Session::hand_over() {
  if (state_ != State::open) return false;
  if (to_plain_.empty()) {
    if (peer_ended_ && !std::exchange(told_plain_, true)) ::shutdown(plain_, SHUT_WR);
    return false;
  }
  const ssize_t size =
      ::send(plain_, &to_plain_.bytes[to_plain_.begin], to_plain_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (size < 0) {
    if (would_block()) return false;
    // It has closed: nobody wants the rest, but what it sent before is not lost.
    to_plain_.begin = to_plain_.end = 0;
    peer_ended_ = told_plain_ = true;
    return false;
  }
  to_plain_.begin += static_cast<std::size_t>(size);
  return true;
}

/// From the plain side.
bool Session::take() {
  if (state_ != State::open || !to_peer_.empty() || plain_ended_) return false;
  const ssize_t size = ::recv(plain_, to_peer_.bytes.data(), to_peer_.bytes.size(), MSG_DONTWAIT);
  if (size > 0) {
    to_peer_.begin = 0;
    to_peer_.end = static_cast<std::size_t>(size);
    return true;
  }
  if (size == 0 || !would_block()) plain_ended_ = true;
  return false;
}

/// To the peer.
bool Session::send() {
  if (state_ != State::open || to_peer_.empty()) return false;
  const Stream::Progress sent = stream_.write(&to_peer_.bytes[to_peer_.begin], to_peer_.size());
  if (sent.bytes > 0) {
    to_peer_.begin += static_cast<std::size_t>(sent.bytes);
    sent_ += static_cast<std::uint64_t>(sent.bytes);
    return true;
  }
  if (!is_blocked(sent)) state_ = State::ended;
  return false;
}

bool Session::is_blocked(const Stream::Progress& progress) {
  socket_wants_ |= progress.wants;
  return progress.wants != 0;
}

}  // namespace coupler::tls
