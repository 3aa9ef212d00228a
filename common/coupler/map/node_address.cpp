// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/node_address.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/network.hpp"

namespace coupler {
namespace {

constexpr std::string_view tcp = "tcp://";
constexpr std::string_view tls = "tls://";
constexpr std::string_view rtu_over_tcp = "rtu+tcp://";
constexpr std::string_view rtu = "rtu:";

constexpr auto form_of_tcp = "write tcp://HOST[:PORT][/UNIT], as in tcp://192.168.1.17:502/1";
constexpr auto form_of_tls = "write tls://HOST[:PORT][/UNIT], as in tls://192.168.1.17:802/1";
constexpr auto form_of_rtu_over_tcp =
    "write rtu+tcp://HOST[:PORT][/UNIT], as in rtu+tcp://192.168.1.17:4001/1";

tl::unexpected<NetworkError> wrong(std::string what, std::string remedy) {
  return tl::unexpected<NetworkError>({std::move(what), std::move(remedy)});
}

tl::unexpected<NetworkError> wrong_line(std::string what) {
  return wrong(std::move(what),
               "write rtu:DEVICE[/UNIT][?SETTINGS], as in "
               "'rtu:/dev/ttyUSB0/17?baud=9600&parity=none&stop_bits=1' (in quotes)");
}

std::optional<unsigned> number(std::string_view text, unsigned least, unsigned most) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) return {};
  return value;
}

/// "ttyUSB0", "ttyACM1", "ttyS0": a port of Linux; a host is called tty… in small letters.
bool is_port_name(std::string_view host) {
  return starts_with(host, "tty") && host.size() > 3 && host[3] >= 'A' && host[3] <= 'Z';
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

/// `form` is the remedy.
tl::expected<NodeAddress, NetworkError> parse_host_and_port(std::string_view rest,
                                                            const Connection& otherwise, const char* form) {
  NodeAddress node{{}, otherwise.port, otherwise.unit};
  if (const auto unit = take_behind(rest, '/'); unit && !unit->empty()) {
    const auto value = number(*unit, 0, 255);
    if (!value) return wrong(fmt::format("the unit id '{}' is not 0 to 255", *unit), form);
    node.unit = static_cast<std::uint8_t>(*value);
  }
  const bool bracketed = take_brackets(rest, node.host);
  if (const auto port = take_behind(rest, ':')) {
    const auto value = number(*port, 1, 65535);
    if (!value) return wrong(fmt::format("the port '{}' is not 1 to 65535", *port), form);
    node.port = static_cast<std::uint16_t>(*value);
  }
  if (!bracketed) node.host = rest;
  if (bracketed && !rest.empty()) return wrong("after ']' only a port may follow", form);
  if (!bracketed && node.host.find(':') != std::string_view::npos)
    return wrong("an IPv6 address must be in brackets: tcp://[fe80::1]:502", form);
  if (node.host.empty()) return wrong("there is no host", form);
  if (is_port_name(node.host))
    return wrong(fmt::format("'{}' is the name of a serial port, not of a host", node.host),
                 fmt::format("give its path: rtu:/dev/{}", node.host));
  const std::string_view written =
      bracketed ? std::string_view(node.host.data() - 1, node.host.size() + 2) : node.host;
  if (const auto host = parse_host(written); !host)
    return wrong(fmt::format("the host '{}' {}", written, host.error().what), host.error().remedy);
  return node;
}

bool set(Serial& line, std::string_view key, std::string_view value) {
  if (key == "parity") {
    const auto parity = parse_word<Serial::Parity>(value);
    line.parity = parity.value_or(line.parity);
    return parity.has_value();
  }
  if (key == "rs485") {
    line.rs485 = value == "true";
    return line.rs485 || value == "false";
  }
  if (key == "stop_bits") {
    const auto bits = number(value, 1, 2);
    line.stop_bits = static_cast<std::uint16_t>(bits.value_or(line.stop_bits));
    return bits.has_value();
  }
  if (key != "baud") return false;
  line.baud = number(value, 1, 4'000'000).value_or(0);
  return is_serial_rate(line.baud);
}

/// Terminals without hardware: the number is a part of the name.
bool is_pseudo_terminal(std::string_view path) {
  constexpr std::string_view folder = "/dev/pts/";
  return starts_with(path, folder) && path.find('/', folder.size()) == std::string_view::npos;
}

tl::expected<NodeAddress, NetworkError> parse_serial_port(std::string_view rest,
                                                          const Connection& otherwise) {
  NodeAddress node;
  node.unit = otherwise.unit;
  node.serial = otherwise.serial;
  const std::size_t mark = std::min(rest.find('?'), rest.size());
  std::string_view settings = rest.substr(std::min(mark + 1, rest.size()));
  rest = rest.substr(0, mark);
  while (!settings.empty()) {
    const std::string_view one = settings.substr(0, settings.find('&'));
    settings.remove_prefix(std::min(one.size() + 1, settings.size()));
    const std::size_t equals = std::min(one.find('='), one.size());
    if (!set(node.serial, one.substr(0, equals), one.substr(std::min(equals + 1, one.size()))))
      return wrong_line(fmt::format("'{}' is no setting of a serial port, or no value of it", one));
  }
  std::string_view path = rest;
  const auto unit = number(take_behind(path, '/').value_or(""), 0, 65535);
  if (unit && !is_pseudo_terminal(rest)) {
    if (*unit > 255) return wrong_line(fmt::format("the unit id '{}' is not 1 to 247", *unit));
    node.unit = static_cast<std::uint8_t>(*unit);
    rest = path;
  }
  if (rest.empty()) return wrong_line("there is no device");
  const bool is_broadcast = node.unit == rtu_broadcast && otherwise.unit == rtu_broadcast;
  if (!is_rtu_unit(node.unit) && !is_broadcast)
    return wrong_line(fmt::format("the unit id '{}' is not 1 to 247", node.unit));
  node.serial.device = rest;
  return node;
}

}  // namespace

bool names_a_node(std::string_view argument) {
  return starts_with(argument, tcp) || starts_with(argument, tls) || starts_with(argument, rtu) ||
         starts_with(argument, rtu_over_tcp);
}

std::string node_argument(const std::string& argument, const Connection& otherwise) {
  if (names_a_node(argument)) return argument;
  const std::string_view over_tcp = otherwise.tls.present() ? tls : tcp;
  return std::string(starts_with(argument, "/") ? rtu : over_tcp) + argument;
}

tl::expected<NodeAddress, NetworkError> parse_node_address(std::string_view argument,
                                                           const Connection& otherwise) {
  if (starts_with(argument, tcp))
    return parse_host_and_port(argument.substr(tcp.size()), otherwise, form_of_tcp);
  if (starts_with(argument, tls)) {
    Connection usual = otherwise;
    if (!otherwise.tls.present()) usual.port = default_tls_port;
    auto node = parse_host_and_port(argument.substr(tls.size()), usual, form_of_tls);
    if (node) node->tls = true;
    return node;
  }
  if (starts_with(argument, rtu)) return parse_serial_port(argument.substr(rtu.size()), otherwise);
  if (!starts_with(argument, rtu_over_tcp))
    return wrong("the address of a device begins with tcp://, tls:// or rtu:", form_of_tcp);
  auto node = parse_host_and_port(argument.substr(rtu_over_tcp.size()), otherwise, form_of_rtu_over_tcp);
  if (!node) return node;
  if (!is_rtu_unit(node->unit))
    return wrong(fmt::format("with RTU the unit id '{}' is not 1 to 247", node->unit), form_of_rtu_over_tcp);
  node->framing = Framing::rtu;
  return node;
}

std::string place_text(const Connection& connection) {
  if (connection.serial.present()) return std::string(connection.serial.device);
  return fmt::format("{} port {}", connection.address, connection.port);
}

std::string node_address_text(const Connection& connection) {
  if (connection.serial.present())
    return fmt::format("{}{}/{}", rtu, connection.serial.device, connection.unit);
  const bool bracketed = connection.address.find(':') != std::string_view::npos;
  const std::string_view scheme = connection.is_rtu() ? rtu_over_tcp : connection.tls.present() ? tls : tcp;
  return fmt::format(bracketed ? "{}[{}]:{}/{}" : "{}{}:{}/{}", scheme, connection.address, connection.port,
                     connection.unit);
}

Map found_at(const Map& map, const NodeAddress& where) {
  Map found = map;
  Connection& connection = found.connection;
  connection.address = where.host;
  connection.port = where.port;
  connection.unit = where.unit;
  connection.framing = where.framing;
  connection.serial = where.serial;
  if (!where.tls) connection.tls = {};
  connection.changed_from(map.connection.is_rtu());
  return found;
}

}  // namespace coupler
