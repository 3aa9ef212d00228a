// SPDX-License-Identifier: Apache-2.0
// Where a node listens, and who may connect.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "coupler/base/descriptor.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/network.hpp"

namespace coupler::device {

/// The networks that may connect; an empty list admits everyone.
class AllowList {
 public:
  AllowList() = default;
  explicit AllowList(std::vector<Network> networks) : networks_(std::move(networks)) {}

  /// The list of the map's `allow`. The error names what is not an address.
  static tl::expected<AllowList, std::string> of(const Map& map);

  bool admits(const sockaddr_storage& peer) const;

 private:
  std::vector<Network> networks_;
};

/// Returns what counts as one client when connections are shared out: an IPv4 address, or the /64 of an IPv6
/// address, since a machine can choose freely among the 2^64 addresses of its network.
IpAddress origin_of(const sockaddr_storage& peer);

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
