// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/node_address.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/network.hpp"

namespace coupler {
namespace {

constexpr std::string_view scheme = "tcp://";

tl::unexpected<NetworkError> wrong(std::string what) {
  return tl::unexpected<NetworkError>(
      {std::move(what), "write tcp://HOST[:PORT][/UNIT], as in tcp://192.168.1.17:502/1"});
}

std::optional<unsigned> number(std::string_view text, unsigned least, unsigned most) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) return {};
  return value;
}

/// Takes what stands behind the last `mark` off the text, if there is one.
std::optional<std::string_view> take_behind(std::string_view& text, char mark) {
  const auto at = text.rfind(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const auto behind = text.substr(at + 1);
  text = text.substr(0, at);
  return behind;
}

/// The brackets of an IPv6 address hold colons that part no port.
bool take_brackets(std::string_view& text, std::string_view& host) {
  const auto end = text.find(']');
  if (text.empty() || text.front() != '[' || end == std::string_view::npos) return false;
  host = text.substr(1, end - 1);
  text.remove_prefix(end + 1);
  return true;
}

}  // namespace

std::string node_argument(const std::string& argument) {
  return names_a_node(argument) ? argument : "tcp://" + argument;
}

tl::expected<NodeAddress, NetworkError> parse_node_address(std::string_view argument,
                                                           const Connection& otherwise) {
  if (!names_a_node(argument)) return wrong("the address of a node begins with tcp://");
  NodeAddress node{{}, otherwise.port, otherwise.unit};
  std::string_view rest = argument.substr(scheme.size());
  if (const auto unit = take_behind(rest, '/'); unit && !unit->empty()) {
    const auto value = number(*unit, 0, 255);
    if (!value) return wrong(fmt::format("the unit id '{}' is not 0 to 255", *unit));
    node.unit = static_cast<std::uint8_t>(*value);
  }
  const bool bracketed = take_brackets(rest, node.host);
  if (const auto port = take_behind(rest, ':')) {
    const auto value = number(*port, 1, 65535);
    if (!value) return wrong(fmt::format("the port '{}' is not 1 to 65535", *port));
    node.port = static_cast<std::uint16_t>(*value);
  }
  if (!bracketed) node.host = rest;
  if (bracketed && !rest.empty()) return wrong("after ']' only a port may follow");
  if (!bracketed && node.host.find(':') != std::string_view::npos)
    return wrong("an IPv6 address must be in brackets: tcp://[fe80::1]:502");
  if (node.host.empty()) return wrong("there is no host");
  const std::string_view written =
      bracketed ? std::string_view(node.host.data() - 1, node.host.size() + 2) : node.host;
  if (const auto host = parse_host(written); !host)
    return tl::unexpected<NetworkError>(
        {fmt::format("the host '{}' {}", written, host.error().what), host.error().remedy});
  return node;
}

std::string node_address_text(const Connection& connection) {
  const bool bracketed = connection.address.find(':') != std::string_view::npos;
  return fmt::format(bracketed ? "{}[{}]:{}/{}" : "{}{}:{}/{}", scheme, connection.address, connection.port,
                     connection.unit);
}

Map found_at(const Map& map, const NodeAddress& where) {
  Map found = map;
  found.connection.address = where.host;
  found.connection.port = where.port;
  found.connection.unit = where.unit;
  return found;
}

}  // namespace coupler
