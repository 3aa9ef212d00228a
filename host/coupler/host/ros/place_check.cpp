// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/place_check.hpp"

#include <string_view>

#include <fmt/format.h>

#include "coupler/map/node_address.hpp"

namespace coupler::host {

std::string place_error(const Settings& settings, const Connection& connection) {
  if (settings.address && settings.serial) return "both address and serial are given; give one of them";
  if (const auto missing = missing_key(connection.tls); !missing.empty())
    return fmt::format("TLS needs {}{}, which is neither a setting nor in the map", missing,
                       missing == "ca" ? " (or pin)" : "");
  if (!connection.tls.ca.empty() && !connection.tls.pin.empty())
    return "both ca and pin are given; give the device's authority, or the pin of its certificate";
  if (connection.is_rtu() && connection.tls.present())
    return "a device that speaks RTU has no TLS; leave out framing: rtu, or the certificate";
  if (!connection.is_rtu() || is_rtu_unit(connection.unit)) return {};
  return fmt::format("unit {} cannot be asked; with RTU give 1 to 247", connection.unit);
}

std::string broadcast_error(const Map& map) {
  if (map.coupler_watchdog.present())
    return "unit 0 is a broadcast, which nobody answers, but 'watchdog' needs answers; give 1 to 247";
  for (const Point& point : map.points)
    if (needs_answers(point, map.limits))
      return fmt::format(
          "unit 0 is a broadcast, which nobody answers, but {} needs to be read; give 1 to 247", point.name);
  return {};
}

std::string useless_setting(const Settings& settings, const Map& map) {
  const auto changes = [](const auto& setting, const auto& value) { return setting && *setting != value; };
  const Connection& before = map.connection;
  const Serial& line = before.serial;
  Map applied = map;
  apply(settings, applied);
  const Connection& connection = applied.connection;
  if (!connection.tls.present())
    for (const auto& [key, given] : {std::pair("tls_name", settings.tls_name), std::pair("pin", settings.pin),
                                     std::pair("ca", settings.ca), std::pair("key", settings.key)})
      if (given && !given->empty() && !connection.serial.present())
        return fmt::format("{} has no meaning without TLS; leave it out, or give certificate, too", key);
  if (connection.serial.present()) {
    if (!changes(settings.port, before.port)) return {};
    return fmt::format(
        "port has no meaning on the serial port {}; leave it out, or give the address of a gateway, too",
        connection.serial.device);
  }
  std::string_view key;
  if (changes(settings.baud, line.baud)) key = "baud";
  if (changes(settings.parity, line.parity)) key = "parity";
  if (changes(settings.stop_bits, line.stop_bits)) key = "stop_bits";
  if (changes(settings.rs485, line.rs485)) key = "rs485";
  if (key.empty() || !connection.present()) return {};
  return fmt::format("{} has no meaning at {}, which is no serial port; leave it out, or give serial, too",
                     key, place_text(connection));
}

}  // namespace coupler::host
