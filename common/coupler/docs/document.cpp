// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/docs/words.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/rights_text.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/picture.hpp"

namespace coupler::docs {
namespace {

/// "65280 (365281)"
std::string both_notations(Table table, std::uint32_t address) {
  return fmt::format("{} ({})", address, plan::modicon(table, address));
}

/// The map has keys that only a node uses: wiring, or how it is served.
bool is_for_node(const Map& map) {
  const auto wired = [](const Point& point) {
    return point.line.present() || is_analogue(point) || point.counter.present() || point.latched.present();
  };
  return !map.sim.empty() || map.service.watchdog.present() || map.service.readback ||
         !map.service.listen.empty() || !map.service.allow.empty() || map.security.present() ||
         std::any_of(map.points.begin(), map.points.end(), wired);
}

FactGroup connection(const Map& map) {
  const Connection& at = map.connection;
  FactGroup group{"Connection", {}};
  if (at.serial.present()) {
    group.facts.push_back({"Serial port", written(at.serial)});
  } else {
    group.facts.push_back({"Address", at.address.empty() ? "not in the map" : std::string(at.address)});
    group.facts.push_back({"Port", fmt::to_string(at.port)});
    if (at.is_rtu()) group.facts.push_back({"Frames", "RTU"});
  }
  group.facts.insert(
      group.facts.end(),
      {{"Unit id", fmt::to_string(at.unit)},
       {"Timeout", words(at.timeout)},
       {"Polled", fmt::format("{} Hz", map.polling.rate)},
       {"Points that are read", map.poll == Poll::all ? "all" : "those that somebody listens to"},
       {"After a reconnect", map.on_reconnect == OnReconnect::restore
                                 ? "outputs are written again"
                                 : "writes without a connection are lost"},
       {"When the driver ends",
        map.on_shutdown == OnShutdown::safe ? "outputs go to their safe values" : "outputs stay"}});
  if (!map.changes) group.facts.push_back({"Changes that it announces", "not listened to"});
  return group;
}

FactGroup limits(const Map& map) {
  const Limits& limits = map.limits;
  FactGroup group{"Limits of a request",
                  {{"Read", fmt::format("{} registers, {} bits", limits.read_registers, limits.read_bits)},
                   {"Write", fmt::format("{} registers, {} bits", limits.write_registers, limits.write_bits)},
                   {"Connections", fmt::to_string(limits.connections)},
                   {"Mask write (FC 22)", limits.mask_write ? "yes" : "not used"}}};
  if (!limits.transaction_ids) group.facts.push_back({"Transaction ids", "not repeated in replies"});
  if (limits.request_gap.count() > 0)
    group.facts.push_back({"Pause before a request", words(limits.request_gap)});
  if (limits.connect_delay.count() > 0)
    group.facts.push_back({"Pause after connecting", words(limits.connect_delay)});
  for (const TableRange& area : map.unreadable)
    group.facts.push_back(
        {"Unreadable", fmt::format("{} {} – {}", words(area.table), area.range.start(), area.range.last())});
  for (const TableRange& area : map.read_whole)
    group.facts.push_back({"Read in one piece", fmt::format("{} {} – {}", words(area.table),
                                                            area.range.start(), area.range.last())});
  return group;
}

std::string watchdog_words(const Watchdog& watchdog) {
  if (!watchdog.present()) return "none";
  return fmt::format("{}, fed by {}, recovery {}", words(watchdog.timeout),
                     watchdog.fed_by == Watchdog::FedBy::any
                         ? "any request of a client that has written an output"
                         : "writes",
                     to_string(watchdog.recovery));
}

FactGroup service(const Map& map) {
  const Service& service = map.service;
  std::string allow;
  for (const std::string_view each : service.allow)
    allow += fmt::format("{}{}", allow.empty() ? "" : ", ", each);
  FactGroup group{"Node",
                  {{"Listens on", service.listen.empty() ? "every interface" : std::string(service.listen)},
                   {"Who may connect", allow.empty() ? "everyone" : allow},
                   {"Watchdog", watchdog_words(service.watchdog)},
                   {"Read back outputs", service.readback ? "yes" : "no"}}};
  for (const Role& role : map.security.roles)
    group.facts.push_back({fmt::format("Role {}", role.name),
                           fmt::format("reads {}; writes {}", rights_text(map, role, Right::read),
                                       rights_text(map, role, Right::write))});
  const auto role_of = [&](std::optional<std::uint16_t> role) {
    return role ? std::string(map.security.roles[*role].name) : "may do nothing";
  };
  if (map.connection.tls.present() && service.port != map.connection.port)
    group.facts.push_back({"Port without TLS", fmt::to_string(service.port)});
  if (map.security.files.present()) group.facts.push_back({"TLS at port", fmt::to_string(map.security.port)});
  if (map.security.files.present())
    group.facts.push_back({"Certificates without a role", role_of(map.security.no_role)});
  if (map.security.present())
    group.facts.push_back(
        {map.security.files.present() ? "Clients without TLS" : "Every client", role_of(map.security.plain)});
  return group;
}

FactGroup identity(const Map& map) {
  FactGroup group{"Identity", {{"Fingerprint", fingerprint_text(map.fingerprint)}}};
  if (!is_for_node(map)) return group;
  constexpr std::uint32_t start = identity::reserved.start();
  group.facts.push_back(
      {"Identity area", fmt::format("{} input registers from {}", std::uint32_t{identity::size},
                                    both_notations(Table::input_registers, start))});
  group.facts.push_back({"Fingerprint in it", "4 from " + both_notations(Table::input_registers,
                                                                         start + identity::at_fingerprint)});
  group.facts.push_back({"The map itself", fmt::format("{} bytes by FC 20 from file 1", map.text.size())});
  if (map.service.watchdog.needs_reset())
    group.facts.push_back(
        {"Watchdog reset", fmt::format("write 0x{:04X} to holding register {}", identity::watchdog_reset_code,
                                       both_notations(Table::holding_registers, start))});
  return group;
}

}  // namespace

Document make_document(const Map& map, Span<const int> lines, Provenance provenance) {
  Document document;
  document.name = map.name;
  document.fingerprint = fingerprint_text(map.fingerprint);
  document.facts = facts_of(map);
  document.points.reserve(map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i)
    document.points.push_back(describe(map.points[i], i < lines.size() ? lines[i] : 0));
  document.tools = describe_tools(map);
  document.axes = describe_axes(map);
  document.mbpoll = mbpoll_commands(map);
  document.ros = ros_commands(map, provenance.file);
  document.drawings = drawings_of(map);
  document.picture = plan::picture(map, plan::make_read_plan(map), {true, "#point-"});
  document.provenance = std::move(provenance);
  return document;
}

std::vector<FactGroup> facts_of(const Map& map) {
  std::vector<FactGroup> groups{connection(map), limits(map)};
  if (is_for_node(map)) groups.push_back(service(map));
  groups.push_back(identity(map));
  return groups;
}

std::string source_link(const Document& document, const PointDescription& point) {
  if (document.provenance.url.empty() || point.line == 0) return {};
  return fmt::format("{}#L{}", document.provenance.url, point.line);
}

std::size_t count(const Document& document, Table table) {
  return static_cast<std::size_t>(
      std::count_if(document.points.begin(), document.points.end(),
                    [&](const PointDescription& point) { return point.table == table; }));
}

}  // namespace coupler::docs
