// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/make_transports.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "coupler/host/modbus/unit_transport.hpp"

namespace coupler::host {
namespace {

struct Gateway {
  std::size_t units = 0;
  std::size_t connections = std::numeric_limits<std::size_t>::max();  ///< that it allows
  std::shared_ptr<SharedConnection> shared;
};

using Place = std::pair<std::string_view, std::uint16_t>;

Place place_of(const Map& map) { return {map.connection.address, map.connection.port}; }

}  // namespace

std::vector<std::unique_ptr<Transport>> make_transports(const std::vector<Map>& maps) {
  std::map<Place, Gateway> gateways;
  for (const Map& map : maps) {
    Gateway& gateway = gateways[place_of(map)];
    ++gateway.units;
    gateway.connections = std::min<std::size_t>(gateway.connections, map.limits.connections);
  }
  std::vector<std::unique_ptr<Transport>> transports;
  for (const Map& map : maps) {
    Gateway& gateway = gateways[place_of(map)];
    if (gateway.units <= std::max<std::size_t>(gateway.connections, 1)) {
      transports.push_back(std::make_unique<ModbusTransport>(map.connection));
      continue;
    }
    if (!gateway.shared) gateway.shared = std::make_shared<SharedConnection>(map.connection);
    transports.push_back(std::make_unique<UnitTransport>(gateway.shared, map.connection, map.limits));
  }
  return transports;
}

}  // namespace coupler::host
