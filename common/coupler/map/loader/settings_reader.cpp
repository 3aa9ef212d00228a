// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_reader.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/network.hpp"

namespace coupler::loader {
namespace {

Watchdog read_watchdog(const Reader& top, const Context& context) {
  Watchdog watchdog;
  const auto reader = top.inside("watchdog", "a map with 'timeout'");
  if (!reader) return watchdog;
  if (reader->lacks("timeout"))
    context.problems.error(top.find("watchdog")->key_at, "'watchdog' has no 'timeout'",
                           "add 'timeout: 500ms', the longest silence of a client");
  reader->fields(watchdog);
  return watchdog;
}

/// A list with every address of one family lets nobody of the other connect, which is probably a mistake.
void warn_of_half(const std::vector<std::pair<Network, const Entry*>>& allowed, const Context& context) {
  const auto lists = [&](bool ipv4) {
    return std::any_of(allowed.begin(), allowed.end(),
                       [&](const auto& one) { return is_ipv4(one.first.address) == ipv4; });
  };
  for (const auto& [network, entry] : allowed) {
    const bool ipv4 = is_ipv4(network.address);
    if (!network.is_whole_family() || lists(!ipv4)) continue;
    context.problems.warning(
        entry->at,
        fmt::format("{} is every {} address, but no {} address", shown(entry->text), ipv4 ? "IPv4" : "IPv6",
                    ipv4 ? "IPv6" : "IPv4"),
        fmt::format("add '{}', or remove 'allow' to let everyone in", ipv4 ? "::/0" : "0.0.0.0/0"));
  }
}

Span<const std::string_view> read_allow(const Reader& top, const Context& context) {
  const Entry* entry = top.find("allow");
  if (entry == nullptr) return {};
  if (entry->kind != Entry::Kind::list) {
    top.wrong("allow", "a list of IP addresses and ranges");
    return {};
  }
  if (entry->children.empty())
    context.problems.error(entry->at, "'allow' is empty",
                           "write who may connect, or remove it to let everyone in");
  std::vector<std::string_view> networks;
  std::vector<std::pair<Network, const Entry*>> allowed;
  for (const Entry& child : entry->children) {
    if (child.kind != Entry::Kind::scalar) {
      context.problems.error(child.at, fmt::format("'allow' lists IP addresses, not {}", shown(child)),
                             "write it as in 'allow: [192.168.0.0/24, 10.0.0.7]'");
    } else if (const auto network = parse_network(child.text); !network) {
      context.problems.error(child.at, fmt::format("{} {}", shown(child.text), network.error().what),
                             network.error().remedy);
    } else {
      networks.push_back(context.map.keep(child.text));
      allowed.emplace_back(*network, &child);
    }
  }
  if (allowed.size() == entry->children.size()) warn_of_half(allowed, context);
  return context.map.keep(networks);
}

std::optional<std::uint16_t> read_end(const Reader& area, std::string_view key, Table table,
                                      Addressing addressing, const Context& context) {
  const Entry& entry = *area.find(key);
  const auto address = parse_address(entry.kind == Entry::Kind::scalar ? entry.text : "", table, addressing);
  if (address) return *address;
  context.problems.error(entry.at, address.error().what, address.error().remedy);
  return std::nullopt;
}

std::optional<Area> read_area(const Entry& entry, std::string_view key, Addressing addressing,
                              const Context& context) {
  const Reader area(entry, Section::area, context);
  if (entry.kind != Entry::Kind::map || !area.missing().empty()) {
    if (entry.kind == Entry::Kind::map && !area.lacks(area.missing())) return std::nullopt;
    context.problems.error(entry.at, fmt::format("an area of '{}' needs 'table', 'from' and 'to'", key),
                           fmt::format("write it as in '{}: [{{table: coils, from: 8, to: 15}}]'", key));
    return std::nullopt;
  }
  const std::size_t errors = context.problems.errors();
  Table table = Table::coils;
  area.choice("table", table);
  if (context.problems.errors() != errors) return std::nullopt;
  const auto from = read_end(area, "from", table, addressing, context);
  const auto to = read_end(area, "to", table, addressing, context);
  if (!from || !to) return std::nullopt;
  if (*to >= *from) return Area{table, modbus::Range::of(*from, *to - *from + 1U), entry.at};
  context.problems.error(area.find("to")->at, "the area ends before it begins",
                         "write the smaller one as 'from'");
  return std::nullopt;
}

}  // namespace

Polling read_polling(const Reader& top) {
  Polling polling;
  top.fields(polling);
  return polling;
}

Limits read_limits(const Reader& top) {
  Limits limits;
  if (const auto reader = top.inside("limits", "a map of limits")) reader->fields(limits);
  return limits;
}

Service read_service(const Reader& top, const Context& context) {
  Service service;
  top.fields(service);
  if (const Entry* entry = top.find("listen");
      entry != nullptr && entry->kind == Entry::Kind::scalar && !is_ip_address(entry->text))
    top.wrong("listen", "an IP address of the node");
  service.allow = read_allow(top, context);
  service.watchdog = read_watchdog(top, context);
  return service;
}

Areas read_areas(const Reader& top, std::string_view key, Addressing addressing, const Context& context) {
  Areas areas;
  const Entry* entry = top.find(key);
  if (entry == nullptr) return areas;
  if (entry->kind != Entry::Kind::list) {
    top.wrong(key, "a list of areas");
    return areas;
  }
  for (const Entry& child : entry->children)
    if (const auto area = read_area(child, key, addressing, context)) areas.push_back(*area);
  return areas;
}

std::vector<TableRange> by_place(const Areas& areas) {
  std::vector<TableRange> sorted;
  for (const Area& area : areas) sorted.push_back({area.table, area.range});
  std::sort(sorted.begin(), sorted.end(), [](const TableRange& a, const TableRange& b) {
    return std::tuple(index(a.table), a.range.start()) < std::tuple(index(b.table), b.range.start());
  });
  return sorted;
}

}  // namespace coupler::loader
