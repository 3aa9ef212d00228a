// SPDX-License-Identifier: Apache-2.0
// Hosts and networks as a map writes them: names, IP addresses, ranges of addresses.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace coupler {

/// An IPv6 address, most significant byte first. IPv4 addresses are mapped into ::ffff:0:0/96 (RFC 4291,
/// 2.5.5.2), as a socket that takes both shows them.
using IpAddress = std::array<std::uint8_t, 16>;

bool is_ipv4(const IpAddress& address);

/// The addresses of one family that share their first `prefix` bits: ::/0 is every IPv6 address, but no IPv4
/// address, although those are mapped into it.
struct Network {
  IpAddress address{};
  unsigned prefix = 128;  ///< 0 … 128, of the mapped address

  bool contains(const IpAddress& other) const;
  /// 0.0.0.0/0 or ::/0.
  bool is_whole_family() const;
};

struct NetworkError {
  std::string what;  ///< "is not an IP address", "has a port": a predicate for the text
  std::string remedy;
};

/// An address, or a range in CIDR notation: "10.0.0.7", "192.168.0.0/24", "fe80::/10". The bits behind the
/// prefix must be zero.
tl::expected<Network, NetworkError> parse_network(std::string_view text);

/// One address: "10.0.0.7", "fd00::7", or with the interface that a link-local one is of, "fe80::7%eth0".
bool is_ip_address(std::string_view text);

/// A host name (RFC 1123, and '_') or an IP address, as a map's `address` is. The result is a part of the
/// text: without the brackets that an IPv6 address may have.
tl::expected<std::string_view, NetworkError> parse_host(std::string_view text);

}  // namespace coupler
