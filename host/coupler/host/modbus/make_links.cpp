// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/make_links.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/modbus/rtu_channel.hpp"
#include "coupler/host/modbus/tcp_channel.hpp"
#include "coupler/map/fields.hpp"

namespace coupler::host {
namespace {

/// The place that several maps can share: a gateway, or a serial port by its real path.
struct Gateway {
  std::size_t units = 0;
  std::size_t connections = std::numeric_limits<std::size_t>::max();  ///< that it allows
  bool transaction_ids = true;                                        ///< all its maps say so
  std::shared_ptr<SharedChannel> shared;
};

std::shared_ptr<SharedChannel> make_channel(const Connection& connection, bool transaction_ids) {
  if (connection.is_rtu()) return std::make_shared<SharedChannel>(std::make_shared<RtuChannel>(connection));
  return std::make_shared<SharedChannel>(std::make_shared<TcpChannel>(connection, transaction_ids));
}

using Place = std::pair<std::string, std::uint16_t>;

Place place_of(const Connection& connection) {
  if (!connection.serial.present()) return {std::string(connection.address), connection.port};
  std::error_code ignored;
  return {std::filesystem::weakly_canonical(connection.serial.device, ignored), 0};
}

/// Compares all settings but the name of the port, of which there may be several.
bool have_same_line(const Connection& a, Connection b) {
  if (!a.serial.present() || !b.serial.present()) return a.is_rtu() == b.is_rtu();
  b.serial.device = a.serial.device;
  return a.serial == b.serial;
}

}  // namespace

std::string line_conflict(const std::vector<Map>& maps) {
  std::map<Place, const Map*> first;
  for (const Map& map : maps) {
    const Map& other = *first.emplace(place_of(map.connection), &map).first->second;
    if (other.connection.tls != map.connection.tls)
      return fmt::format(
          "{} and {} are behind one address and port, but one has {} as 'tls', and the other {}; give both "
          "the same",
          other.name, map.name, written(other.connection.tls), written(map.connection.tls));
    if (have_same_line(other.connection, map.connection)) continue;
    const auto settings = [](const Map& of) {
      return of.connection.serial.present() ? written(of.connection.serial)
                                            : fmt::format("framing {}", to_string(of.connection.framing));
    };
    return fmt::format(
        "{} and {} are on one line, but one has {} and the other {}; give both the same settings", other.name,
        map.name, settings(other), settings(map));
  }
  return {};
}

Link make_link(const Connection& connection, const Limits& limits) {
  return Link(make_channel(connection, limits.transaction_ids), connection, limits);
}

std::vector<std::unique_ptr<Link>> make_links(const std::vector<Map>& maps) {
  std::map<Place, Gateway> gateways;
  for (const Map& map : maps) {
    Gateway& gateway = gateways[place_of(map.connection)];
    ++gateway.units;
    gateway.connections = std::min<std::size_t>(gateway.connections, map.limits.connections);
    gateway.transaction_ids = gateway.transaction_ids && map.limits.transaction_ids;
  }
  std::vector<std::unique_ptr<Link>> links;
  for (const Map& map : maps) {
    Gateway& gateway = gateways[place_of(map.connection)];
    const bool shares =
        map.connection.is_rtu() || gateway.units > std::max<std::size_t>(gateway.connections, 1);
    auto shared = gateway.shared ? gateway.shared : make_channel(map.connection, gateway.transaction_ids);
    if (shares) gateway.shared = shared;
    shared->has_several_links = gateway.units > 1 && shares;
    links.push_back(std::make_unique<Link>(std::move(shared), map.connection, map.limits));
  }
  return links;
}

}  // namespace coupler::host
