// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/settings_reader.hpp"

#include <fmt/format.h>

#include "common/map/host.hpp"

namespace coupler::loader {

Connection read_connection(const Reader& top, Context& context) {
  Connection connection;
  top.text("address", connection.address);
  if (!connection.address.empty()) {
    if (const auto host = parse_host(connection.address))
      connection.address = *host;
    else
      context.problems.error(top.find("address")->at,
                             fmt::format("'address': '{}' {}", connection.address, host.error().what),
                             host.error().remedy);
  }
  top.integer("port", connection.port);
  top.integer("unit", connection.unit);
  top.duration("timeout", connection.timeout);
  return connection;
}

Polling read_polling(const Reader& top) {
  Polling polling;
  top.number("rate", polling.rate);
  top.boolean("discrete_read_continuous", polling.discrete_continuous);
  top.integer("discrete_read_separation_gap", polling.discrete_gap);
  top.boolean("registers_read_continuous", polling.register_continuous);
  top.integer("registers_read_separation_gap", polling.register_gap);
  return polling;
}

Limits read_limits(const Reader& top, Context& context) {
  Limits limits;
  const Entry* entry = top.find("limits");
  if (entry == nullptr) return limits;
  if (entry->kind != Entry::Kind::map) {
    top.wrong("limits", "a map of limits");
    return limits;
  }
  const Reader reader(*entry, Section::limits, context);
  reader.integer("read_registers", limits.read_registers);
  reader.integer("read_bits", limits.read_bits);
  reader.integer("write_registers", limits.write_registers);
  reader.integer("write_bits", limits.write_bits);
  reader.duration("request_gap", limits.request_gap);
  reader.duration("connect_delay", limits.connect_delay);
  reader.integer("connections", limits.connections);
  reader.boolean("mask_write", limits.mask_write);
  return limits;
}

}  // namespace coupler::loader
