// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "coupler/tls/context.hpp"

namespace coupler::tls {

/// A connection whose bytes its owner takes and gives (a Session carries them to and from a plain socket).
/// The handshake is a part of the first call.
class Stream {
 public:
  /// Over a connected socket. Both outlive it. Throws std::bad_alloc like any container.
  Stream(const Context& context, int socket) : ssl_(context.connection(socket, verification_)) {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  /// Tells the other side that this was all.
  ~Stream();

  struct Progress {
    int bytes = 0;    ///< 0: none yet, if `wants` says something; otherwise it has ended, or failed
    short wants = 0;  ///< events of poll(2) after which to try again
  };
  Progress read(char* to, std::size_t size);
  Progress write(const char* from, std::size_t size);

  /// The other side has not ended it, as far as can be told without waiting.
  bool is_there();

 private:
  Progress progress(int result);

  Verification verification_;
  SslPtr ssl_;
  bool is_good_ = false;     ///< the last call was
  bool has_failed_ = false;  ///< a call was not
};

}  // namespace coupler::tls
