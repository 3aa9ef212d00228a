// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/session.hpp"

#include <openssl/err.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "coupler/tls/alert.hpp"

namespace coupler::tls {
namespace {

/// So many times in one call; others have a turn after that.
constexpr int most_rounds = 8;

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

// NOLINTNEXTLINE(readability-function-size): the parameters are those of SSL_set_msg_callback(3)
void note(int is_sent, int, int content, const void*, std::size_t, SSL*, void* session) {
  if (is_sent == 0 && content == SSL3_RT_HANDSHAKE) static_cast<Session*>(session)->note_message();
}

}  // namespace

Session::Session(SslPtr ssl, const Verification& verification)
    : ssl_(std::move(ssl)),
      verification_(verification),
      socket_wants_(SSL_is_server(ssl_.get()) != 0 ? POLLIN : POLLOUT) {
  SSL_set_msg_callback(ssl_.get(), note);
  SSL_set_msg_callback_arg(ssl_.get(), this);
}

std::optional<std::string> Session::why_refused_by(const Context& context) const {
  return context.why_refused(SSL_get0_peer_certificate(ssl_.get()), SSL_get_peer_cert_chain(ssl_.get()));
}

Session::State Session::shake_hands() {
  ERR_clear_error();
  socket_wants_ = 0;
  const int result = SSL_do_handshake(ssl_.get());
  if (result == 1) {
    state_ = State::open;
    messages_ = 0;
  } else if (!is_blocked(result)) {
    fail(result);
  }
  return state_;
}

Session::State Session::pump() {
  socket_wants_ = 0;
  reads_when_written_ = false;
  for (int round = 0; state_ == State::open && round < most_rounds; ++round) {
    bool moved = take();
    moved = send() || moved;
    moved = receive() || moved;
    moved = hand_over() || moved;
    if (!moved) break;
  }
  if (state_ == State::open && plain_ended_ && to_peer_.empty()) {
    (void)SSL_shutdown(ssl_.get());  // what the socket does not take at once is not missed
    end();
  }
  return state_;
}

Session::Wants Session::wants() const {
  Wants wants{socket_wants_, 0};
  if (state_ != State::open) return wants;
  const bool reads = !peer_ended_ && !reads_when_written_;
  if (to_plain_.empty() && reads) wants.socket |= POLLIN;
  if (to_peer_.empty() && !plain_ended_) wants.plain |= POLLIN;
  // poll() does not report bytes that OpenSSL has already decrypted.
  if (!to_plain_.empty() || (reads && SSL_pending(ssl_.get()) > 0)) wants.plain |= POLLOUT;
  return wants;
}

/// From the peer.
bool Session::receive() {
  if (state_ != State::open || !to_plain_.empty() || peer_ended_) return false;
  ERR_clear_error();
  const int size = SSL_read(ssl_.get(), to_plain_.bytes.data(), static_cast<int>(to_plain_.bytes.size()));
  if (messages_ > most_messages) {
    end("it sends messages of the handshake without data between them");
    return false;
  }
  if (size > 0) {
    to_plain_.begin = 0;
    to_plain_.end = static_cast<std::size_t>(size);
    messages_ = 0;
    return true;
  }
  if (SSL_get_error(ssl_.get(), size) == SSL_ERROR_ZERO_RETURN)
    peer_ended_ = true;
  else if (!is_blocked(size))
    fail(size);
  else
    reads_when_written_ = SSL_want_write(ssl_.get()) != 0;
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
  ERR_clear_error();
  const int size = SSL_write(ssl_.get(), &to_peer_.bytes[to_peer_.begin], static_cast<int>(to_peer_.size()));
  if (size > 0) {
    to_peer_.begin += static_cast<std::size_t>(size);
    sent_ += static_cast<std::uint64_t>(size);
    return true;
  }
  if (!is_blocked(size)) fail(size);
  return false;
}

/// Returns whether the call only waits for the socket.
bool Session::is_blocked(int result) {
  const int kind = SSL_get_error(ssl_.get(), result);
  if (kind == SSL_ERROR_WANT_READ)
    socket_wants_ |= POLLIN;
  else if (kind == SSL_ERROR_WANT_WRITE)
    socket_wants_ |= POLLOUT;
  else
    return false;
  return true;
}

void Session::fail(int result) {
  std::string problem = failure_text(ssl_.get(), result, verification_);
  if (state_ == State::open && problem == has_left) problem.clear();
  end(std::move(problem));
}

void Session::end(std::string problem) {
  state_ = State::ended;
  problem_ = std::move(problem);
}

}  // namespace coupler::tls
