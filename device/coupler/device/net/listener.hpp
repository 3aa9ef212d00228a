// SPDX-License-Identifier: Apache-2.0
// Where a node listens.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/net/allow_list.hpp"

namespace coupler::device {

/// A non-blocking socket that listens.
struct Listener {
  Descriptor socket;
  std::string name;  ///< "127.0.0.1:1502", "[::]:502"
  AllowList allowed{};

  /// Another descriptor of the same socket, open to everyone. The error says why there is none.
  tl::expected<Listener, std::string> share() const;
};

/// Listens on a TCP port (0: any free one, which `name` tells), open to everyone. `address` is an IP
/// address; empty: every interface, IPv6 and IPv4. The error says what failed and what to do; `option`
/// chooses another port.
tl::expected<Listener, std::string> listen_on(const std::string& address, std::uint16_t port,
                                              const char* option = "--port");

}  // namespace coupler::device
