// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/stream.hpp"

#include <poll.h>

#include <openssl/err.h>

#include <algorithm>
#include <limits>

namespace coupler::tls {
namespace {

int at_most(std::size_t size) {
  return static_cast<int>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
}

}  // namespace

Stream::~Stream() {
  if (is_good_) SSL_shutdown(ssl_.get());  // not after an error, as OpenSSL's manual says
  ERR_clear_error();
}

Stream::Progress Stream::read(char* to, std::size_t size) {
  ERR_clear_error();
  return progress(SSL_read(ssl_.get(), to, at_most(size)));
}

Stream::Progress Stream::write(const char* from, std::size_t size) {
  ERR_clear_error();
  return progress(SSL_write(ssl_.get(), from, at_most(size)));
}

bool Stream::is_there() {
  if (has_failed_) return false;  // OpenSSL 3.5 would wait for more
  char next = 0;
  ERR_clear_error();
  const Progress peeked = progress(SSL_peek(ssl_.get(), &next, 1));
  return peeked.bytes > 0 || peeked.wants != 0;
}

Stream::Progress Stream::progress(int result) {
  const int problem = SSL_get_error(ssl_.get(), result);
  is_good_ = problem == SSL_ERROR_NONE || problem == SSL_ERROR_WANT_READ || problem == SSL_ERROR_WANT_WRITE ||
             problem == SSL_ERROR_ZERO_RETURN;
  has_failed_ |= !is_good_;
  if (result > 0) return {result, 0};
  if (problem == SSL_ERROR_WANT_READ) return {0, POLLIN};
  if (problem == SSL_ERROR_WANT_WRITE) return {0, POLLOUT};
  return {};
}

}  // namespace coupler::tls
