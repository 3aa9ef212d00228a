// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/ssl.h>

#include <cstddef>
#include <optional>
#include <string>

#include "coupler/tls/context.hpp"
#include "coupler/tls/openssl.hpp"
#include "coupler/tls/verification.hpp"

namespace coupler::tls {

/// A TLS connection whose bytes its owner takes and gives. It never waits. One thread at a time.
class Stream {
 public:
  /// Over a connected, non-blocking socket, which outlives it. `verification` says whom to believe. Throws
  /// std::bad_alloc like any container.
  Stream(const Context& context, int socket, Verification verification = {});
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  struct Progress {
    int bytes = 0;    ///< 0: none yet, if `wants` says something; otherwise it has ended, or failed
    short wants = 0;  ///< events of poll(2) after which to try again
  };
  /// Continues the handshake, as read() and write() also do. Progress::bytes is 1 once it is complete.
  Progress shake_hands();
  Progress read(void* to, std::size_t size);
  Progress write(const void* from, std::size_t size);
  /// Returns whether read() has bytes that poll(2) does not report, since they have been decrypted.
  bool has_pending() const { return SSL_pending(ssl_.get()) > 0; }
  /// The other side has not ended it, as far as can be told without waiting.
  bool is_there();
  /// Tells the other side that this was all.
  void close();

  /// A call has failed: nothing works any more.
  bool has_failed() const { return has_failed_; }
  /// Once it has: why, and what to do. Empty if the other side left after the handshake, without a word.
  const std::string& problem() const { return problem_; }

  /// The findings about the other side.
  const Verification& verification() const { return verification_; }
  /// The validity of the peer's certificate, once the handshake is over.
  Validity peer_validity() const { return validity_of(SSL_get0_peer_certificate(ssl_.get())); }
  SSL* ssl() const { return ssl_.get(); }

  /// Counts a message of the handshake protocol, which a peer may send at any time: OpenSSL calls it.
  void note_message() { ++messages_; }

 private:
  /// In a row after the handshake, without data between them: a peer needs one key update in 2^24 frames.
  static constexpr int most_messages = 32;

  Progress progress(int result);
  void fail(std::string problem);

  Verification verification_;
  SslPtr ssl_;
  bool is_open_ = false;  ///< the handshake is over
  bool has_failed_ = false;
  int messages_ = 0;
  std::string problem_;
};

}  // namespace coupler::tls
