// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "coupler/tls/stream.hpp"

namespace coupler::tls {

/// A TLS connection, first in its handshake, then carrying bytes both ways between it and a plain descriptor.
/// It never waits: each call does what can be done, and wants() tells what to wait for. It keeps at most a
/// few frames each way, so whoever does not read holds up only itself. Owns neither descriptor.
class Session {
 public:
  enum class State { handshake, open, ended };
  /// poll(2)'s events; 0: none.
  struct Wants {
    short socket = 0;
    short plain = 0;
  };

  /// See Stream.
  Session(const Context& context, int socket, Verification verification);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Goes on with the handshake.
  State shake_hands();
  /// The handshake is over: bytes go to and from this connected, non-blocking stream socket. What comes back
  /// goes to the other side; its end ends the session, after what came before it.
  void carry(int plain) { plain_ = plain; }
  /// Goes on with that.
  State pump();
  Wants wants() const;
  State state() const { return state_; }

  /// Only what is left is sent, and nothing more comes.
  bool is_ending() const { return plain_ended_; }
  /// How many bytes the peer was sent so far.
  std::uint64_t sent() const { return sent_; }
  /// Once it has ended: why, and what to do; empty: either side ended it in order.
  const std::string& problem() const { return stream_.problem(); }
  /// "TLSv1.3"
  const char* version() const { return SSL_get_version(ssl()); }
  const Verification& verification() const { return stream_.verification(); }
  /// Why a context would not believe the peer's certificate now, though its time does not count; nullopt: it
  /// would.
  std::optional<std::string> why_refused_by(const Context& context) const;
  SSL* ssl() const { return stream_.ssl(); }

 private:
  /// A buffer that holds several frames of Modbus.
  struct Buffer {
    std::array<std::uint8_t, 2048> bytes{};
    std::size_t begin = 0;
    std::size_t end = 0;
    bool empty() const { return begin == end; }
    std::size_t size() const { return end - begin; }
  };

  bool receive();
  bool hand_over();
  bool take();
  bool send();
  /// Notes what to wait for. Returns false if there is nothing: it ends then.
  bool is_blocked(const Stream::Progress& progress);

  Stream stream_;
  int plain_ = -1;
  State state_ = State::handshake;
  short socket_wants_;
  Buffer to_plain_;
  Buffer to_peer_;
  bool peer_ended_ = false;   ///< it sends no more
  bool plain_ended_ = false;  ///< nothing more comes from there
  bool told_plain_ = false;   ///< that the peer sends no more
  bool reads_when_written_ =
      false;  ///< what OpenSSL has to say first does not go out: nothing is read before
  std::uint64_t sent_ = 0;
};

}  // namespace coupler::tls
