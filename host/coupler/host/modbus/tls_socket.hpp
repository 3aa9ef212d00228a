// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "coupler/base/span.hpp"
#include "coupler/host/core/channel.hpp"
#include "coupler/map/tls_texts.hpp"

namespace coupler::host {

/// A TLS connection to a device over a socket, after its handshake. One thread at a time may call it, but any
/// thread has_pending().
class TlsSocket {
 public:
  /// Tells the device that this was all.
  virtual ~TlsSocket() = default;

  /// These behave as recv(2) and send(2) of a non-blocking socket.
  virtual ssize_t receive(Span<std::uint8_t> room) = 0;
  virtual ssize_t send(modbus::Bytes bytes) = 0;
  /// Returns whether receive() has bytes that poll(2) does not report, since they have been decrypted.
  virtual bool has_pending() const = 0;
  /// Why a call has failed, and what to do. Empty if none has, or if the other side left after the handshake,
  /// with or without saying so.
  virtual std::string problem() const = 0;
  virtual Certificates certificates() const = 0;
};

/// Reads the certificates, and shakes hands with `host` over a connected, non-blocking socket, which outlives
/// the result. `interrupt` ends it. Errors: NotConnected, which says what to do, but not which host.
Result<std::unique_ptr<TlsSocket>> open_tls(int socket, const std::string& host, const TlsTexts& tls,
                                            const Deadline& deadline, const Event& interrupt);

}  // namespace coupler::host
