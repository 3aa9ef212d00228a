// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/socket_bio.hpp"

#include <sys/socket.h>

#include <cstdint>
#include <new>

#include "coupler/base/descriptor.hpp"

namespace coupler::tls {
namespace {

using MethodPtr = std::unique_ptr<BIO_METHOD, FreedBy<BIO_meth_free>>;

int socket_of(BIO* bio) { return static_cast<int>(reinterpret_cast<std::intptr_t>(BIO_get_data(bio))); }

int write(BIO* bio, const char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const ssize_t sent =
      ::send(socket_of(bio), bytes, static_cast<std::size_t>(size), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0 && would_block()) BIO_set_retry_write(bio);
  return static_cast<int>(sent);
}

int read(BIO* bio, char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const ssize_t got = ::recv(socket_of(bio), bytes, static_cast<std::size_t>(size), MSG_DONTWAIT);
  if (got < 0 && would_block()) BIO_set_retry_read(bio);
  if (got == 0) BIO_set_flags(bio, BIO_FLAGS_IN_EOF);
  return static_cast<int>(got);
}

long control(BIO* bio, int what, long, void*) {
  if (what == BIO_CTRL_EOF) return BIO_test_flags(bio, BIO_FLAGS_IN_EOF) != 0 ? 1 : 0;
  return what == BIO_CTRL_FLUSH ? 1 : 0;  // nothing is buffered
}

const BIO_METHOD* method() {
  static const MethodPtr method = [] {
    MethodPtr made(BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket without SIGPIPE"));
    if (!made) throw std::bad_alloc();
    BIO_meth_set_write(made.get(), write);
    BIO_meth_set_read(made.get(), read);
    BIO_meth_set_ctrl(made.get(), control);
    return made;
  }();
  return method.get();
}

}  // namespace

BioPtr socket_bio(int socket) {
  BioPtr bio(BIO_new(method()));
  if (!bio) throw std::bad_alloc();
  const std::intptr_t number = socket;
  BIO_set_data(bio.get(), reinterpret_cast<void*>(number));  // NOLINT(performance-no-int-to-ptr)
  BIO_set_init(bio.get(), 1);
  return bio;
}

}  // namespace coupler::tls
