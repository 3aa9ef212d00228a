// SPDX-License-Identifier: Apache-2.0
// A device in place of a map's file: tcp://HOST[:PORT][/UNIT], tls://HOST[:PORT][/UNIT],
// rtu+tcp://HOST[:PORT][/UNIT] or rtu:DEVICE[/UNIT][?baud=…&parity=…&stop_bits=…&rs485=…].
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/map/map.hpp"
#include "coupler/map/network.hpp"

namespace coupler {

/// The place of a device.
struct NodeAddress {
  std::string_view host;  ///< a part of the argument: a name or an address, IPv6 without its brackets
  std::uint16_t port = modbus::default_port;
  std::uint8_t unit = Connection{}.unit;
  Framing framing = Framing::tcp;
  Serial serial{};  ///< its device is a part of the argument
  bool tls = false;
};

/// The argument means a device, well written or not.
bool names_a_node(std::string_view argument);

/// Completes the argument of a command that expects a device in any case: "tcp://" may be left out ("tls://"
/// if `otherwise` has that), and so may "rtu:" before a path.
std::string node_argument(const std::string& argument, const Connection& otherwise = {});

/// "tcp://10.0.0.7", "tcp://cell:1502/3", "tcp://[fe80::1]:502", "rtu:/dev/ttyUSB0/17?baud=9600&parity=none".
/// What is not given is `otherwise`'s.
tl::expected<NodeAddress, NetworkError> parse_node_address(std::string_view argument,
                                                           const Connection& otherwise = {});

/// Returns a text for people: "cell port 1502", "/dev/ttyUSB0".
std::string place_text(const Connection& connection);

/// The other way round: "tcp://cell:1502/3", "rtu:/dev/ttyUSB0/17".
std::string node_address_text(const Connection& connection);

/// `map` with the connection of where it was found, which counts, not where it says that it is. It views the
/// argument that `where` was read from. With TLS the certificates are the map's.
Map found_at(const Map& map, const NodeAddress& where);

}  // namespace coupler
