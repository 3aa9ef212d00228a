// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "coupler/host/panel/request_stream.hpp"

namespace coupler::host {

/// What turns HTTP into HTTPS (read_page_tls()). Browsers need no certificate of their own.
class PageTls {
 public:
  virtual ~PageTls() = default;

  /// Of a connection that a browser has just made. In any thread.
  virtual std::unique_ptr<RequestStream> stream(socket_t socket, const std::atomic<bool>& ending) const = 0;
  /// As PanelServer::objection(), where browsers call it by this name or address.
  virtual std::optional<std::string> objection(const std::string& host) const = 0;
};

}  // namespace coupler::host
