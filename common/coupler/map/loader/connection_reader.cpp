// SPDX-License-Identifier: Apache-2.0
// Where the coupler is: at an address, or on a serial line.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/map/network.hpp"

namespace coupler::loader {
namespace {

void check_address(const Reader& top, Connection& connection, const Context& context) {
  if (connection.address.empty()) return;
  if (const auto host = parse_host(connection.address))
    connection.address = *host;
  else
    context.problems.error(top.find("address")->at,
                           fmt::format("'address': '{}' {}", connection.address, host.error().what),
                           host.error().remedy);
}

void check_serial(const Reader& top, const Connection& connection, const Context& context) {
  const Entry* entry = top.find("serial");
  if (entry == nullptr || entry->kind != Entry::Kind::map) return;
  const auto is_meant = [](const Entry& key) {
    return key.key == "device" || nearest(key.key, key_names(Section::serial)) == "device";
  };
  if (std::none_of(entry->children.begin(), entry->children.end(), is_meant))
    context.problems.error(entry->key_at, "'serial' has no 'device'",
                           "add the port's device file, as in 'device: /dev/ttyUSB0'");
  if (!is_serial_rate(connection.serial.baud))
    context.problems.error(child(*entry, "baud")->at,
                           fmt::format("'baud': {} is no rate of serial ports", connection.serial.baud),
                           fmt::format("write one of {}", fmt::join(serial_rates, ", ")));
  for (const std::string_view other : {"address", "port", "framing"})
    if (top.has(other))
      context.problems.error(
          top.find(other)->key_at, fmt::format("the map has both '{}' and 'serial'", other),
          fmt::format("remove '{}' if the device is on a serial line, else 'serial'", other));
}

void check_tls(const Reader& top, Connection& connection, const Context& context) {
  const auto reader = top.inside("tls", "a map");
  if (!reader) return;
  const Position at = top.find("tls")->key_at;
  if (context.served) {  // how to reach it is for whoever does
    connection.tls = {};
    return;
  }
  connection.tls.folder = context.folder;
  for (const std::string_view key : {"certificate", "key", "ca"}) check_pem_path(*reader, key, context);
  for (const std::string_view key : {"certificate", "key"})
    if (reader->lacks(key))
      context.problems.error(
          at, fmt::format("'tls' has no '{}'", key),
          fmt::format("add the path of that file, as in '{}: {}'", key, reader->example(key)));
  if (reader->has("pin") == reader->has("ca"))
    context.problems.error(
        at, reader->has("pin") ? "'tls' has both 'ca' and 'pin'" : "'tls' has neither 'ca' nor 'pin'",
        "give the device's authority, or the pin that 'coupler pin HOST' shows");
  if (reader->has("pin") && !is_pin(connection.tls.pin))
    context.problems.error(reader->find("pin")->at, fmt::format("'pin': '{}' is no pin", connection.tls.pin),
                           "write 'sha256:' and 64 hexadecimal digits, as 'coupler pin HOST' shows them");
  if (connection.is_rtu()) context.problems.error(at, "a device that speaks RTU has no TLS", "remove 'tls'");
  if (reader->has("port"))
    reader->integer("port", connection.port);
  else if (!top.has("port"))
    connection.port = default_tls_port;
}

/// MSL 2.2
void check_unit(const Reader& top, const Connection& connection, const Context& context) {
  if (!connection.is_rtu() || connection.is_broadcast() || is_rtu_unit(connection.unit)) return;
  context.problems.error(top.find("unit")->at,
                         fmt::format("'unit': {} is reserved on a serial line", connection.unit),
                         "write the device's own, 1 to 247");
}

}  // namespace

Connection read_connection(const Reader& top, const Entry* usual_line, std::uint16_t& port_without_tls,
                           const Context& context) {
  Connection connection;
  if (usual_line != nullptr) Reader(*usual_line, Section::serial, context).fields(connection.serial);
  top.fields(connection);
  port_without_tls = connection.port;
  check_address(top, connection, context);
  check_serial(top, connection, context);
  check_tls(top, connection, context);
  check_unit(top, connection, context);
  if (!top.has("timeout")) connection.timeout = usual_timeout(connection.is_rtu());
  return connection;
}

}  // namespace coupler::loader
