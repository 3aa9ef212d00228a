// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "coupler/host/panel/request_stream.hpp"

namespace coupler::host {

/// The TLS side of HTTPS (read_page_tls()). Browsers need no certificate of their own.
class PageTls {
 public:
  virtual ~PageTls() = default;

  /// Begins TLS on a connection that a browser has just made. Any thread may call it.
  virtual std::unique_ptr<RequestStream> stream(socket_t socket, const std::atomic<bool>& ending) const = 0;
  /// See PanelServer::objection(). Browsers reach the panel by this name or address.
  virtual std::optional<std::string> objection(const std::string& host) const = 0;
};

}  // namespace coupler::host
