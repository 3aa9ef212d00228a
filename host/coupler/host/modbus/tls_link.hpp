// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/wakeup.hpp"
#include "coupler/map/tls_texts.hpp"

namespace coupler::host {

/// A TLS connection to a device, which looks like a plain one: a thread carries bytes between it and a
/// socket.
class TlsLink {
 public:
  virtual ~TlsLink() = default;

  /// A connected, non-blocking stream socket, in place of that of the connection. The caller owns it; its end
  /// ends the connection.
  virtual Descriptor take_socket() = 0;
  /// Once that is at its end: why, and what to do; empty: either side ended the connection in order. From any
  /// thread.
  virtual std::string problem() const = 0;
  virtual Certificates certificates() const = 0;
};

/// Reads the certificates, and shakes hands with `host` over a connected, non-blocking socket. `interrupt`
/// ends it. Errors: NotConnected, which says what to do, but not which host.
Result<std::unique_ptr<TlsLink>> open_tls(Descriptor socket, const std::string& host, const TlsTexts& tls,
                                          const Deadline& deadline, const Event& interrupt);

}  // namespace coupler::host
