// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/stream.hpp"

#include <openssl/err.h>
#include <poll.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "coupler/tls/alert.hpp"

namespace coupler::tls {
namespace {

int at_most(std::size_t size) {
  return static_cast<int>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
}

// NOLINTNEXTLINE(readability-function-size): the parameters are those of SSL_set_msg_callback(3)
void note(int is_sent, int, int content, const void*, std::size_t, SSL*, void* stream) {
  if (is_sent == 0 && content == SSL3_RT_HANDSHAKE) static_cast<Stream*>(stream)->note_message();
}

}  // namespace

Stream::Stream(const Context& context, int socket, Verification verification)
    : verification_(std::move(verification)), ssl_(context.connection(socket, verification_)) {
  SSL_set_msg_callback(ssl_.get(), note);
  SSL_set_msg_callback_arg(ssl_.get(), this);
}

Stream::Progress Stream::shake_hands() {
  ERR_clear_error();
  return progress(SSL_do_handshake(ssl_.get()));
}

Stream::Progress Stream::read(void* to, std::size_t size) {
  if (has_failed_) return {};  // OpenSSL 3.5 would wait for more
  ERR_clear_error();
  const Progress got = progress(SSL_read(ssl_.get(), to, at_most(size)));
  if (got.bytes > 0) messages_ = 0;
  return got;
}

Stream::Progress Stream::write(const void* from, std::size_t size) {
  if (has_failed_) return {};
  ERR_clear_error();
  return progress(SSL_write(ssl_.get(), from, at_most(size)));
}

bool Stream::is_there() {
  if (has_failed_) return false;
  char next = 0;
  ERR_clear_error();
  const Progress peeked = progress(SSL_peek(ssl_.get(), &next, 1));
  return peeked.bytes > 0 || peeked.wants != 0;
}

void Stream::close() {
  if (!has_failed_) (void)SSL_shutdown(ssl_.get());  // not after an error, as OpenSSL's manual says
  ERR_clear_error();
}

Stream::Progress Stream::progress(int result) {
  const int kind = SSL_get_error(ssl_.get(), result);
  if (!is_open_ && SSL_is_init_finished(ssl_.get()) != 0) {
    is_open_ = true;
    messages_ = 0;
  }
  if (is_open_ && messages_ > most_messages) {
    fail("it sends messages of the handshake without data between them");
    return {};
  }
  if (result > 0) return {result, 0};
  if (kind == SSL_ERROR_WANT_READ) return {0, POLLIN};
  if (kind == SSL_ERROR_WANT_WRITE) return {0, POLLOUT};
  if (is_open_ && kind == SSL_ERROR_ZERO_RETURN) return {};  // it sends no more
  std::string problem = failure_text(ssl_.get(), result, verification_);
  if (is_open_ && problem == has_left) problem.clear();
  fail(std::move(problem));
  return {};
}

void Stream::fail(std::string problem) {
  has_failed_ = true;
  problem_ = std::move(problem);
}

}  // namespace coupler::tls
