// SPDX-License-Identifier: Apache-2.0
// A node in place of a map's file: tcp://HOST[:PORT][/UNIT].
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/map/map.hpp"
#include "coupler/map/network.hpp"

namespace coupler {

/// Where a node is that serves its map.
struct NodeAddress {
  std::string_view host;  ///< a part of the argument: a name or an address, IPv6 without its brackets
  std::uint16_t port = modbus::default_port;
  std::uint8_t unit = Connection{}.unit;
};

/// The argument means a node, well written or not.
constexpr bool names_a_node(std::string_view argument) { return argument.substr(0, 6) == "tcp://"; }

/// Where a command expects a node in any case, "tcp://" may be left out.
std::string node_argument(const std::string& argument);

/// "tcp://10.0.0.7", "tcp://cell:1502/3", "tcp://[fe80::1]:502". A port or unit that is not given is
/// `otherwise`'s.
tl::expected<NodeAddress, NetworkError> parse_node_address(std::string_view argument,
                                                           const Connection& otherwise = {});

/// The other way round, everything given: "tcp://cell:1502/3".
std::string node_address_text(const Connection& connection);

/// `map` with the connection of where it was found, which counts, not where it says that it is. It views the
/// argument that `where` was read from.
Map found_at(const Map& map, const NodeAddress& where);

}  // namespace coupler
