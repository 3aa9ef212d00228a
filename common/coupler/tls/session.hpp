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
  /// Call it after the handshake: bytes then go to and from `plain`, a connected, non-blocking stream socket.
  /// When `plain` ends, the session ends once the bytes that came from it have been sent to the peer.
  void carry(int plain) { plain_ = plain; }
  /// Carries what can be carried now, without waiting. Returns state().
  State pump();
  Wants wants() const;
  State state() const { return state_; }

  /// Only what is left is sent, and nothing more comes.
  bool is_ending() const { return plain_ended_; }
  /// How many bytes the peer was sent so far.
  std::uint64_t sent() const { return sent_; }
  /// Why it has ended, and what to do. Empty if it has not, or if a side left after the handshake, with or
  /// without saying so.
  const std::string& problem() const { return stream_.problem(); }
  /// "TLSv1.3"
  const char* version() const { return SSL_get_version(ssl()); }
  const Verification& verification() const { return stream_.verification(); }
  /// Returns why `context` would not accept the peer's certificate now, leaving its validity period aside;
  /// nullopt if it would.
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
  bool peer_ended_ = false;   ///< nothing more is read from the peer: it ended, or plain_ takes no more
  bool plain_ended_ = false;  ///< nothing more comes from there
  bool told_plain_ = false;   ///< that the peer sends no more
  /// OpenSSL has to send something before it can read on, and the socket takes nothing now.
  bool read_needs_write_ = false;
  std::uint64_t sent_ = 0;
};

}  // namespace coupler::tls
