// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_keys.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/host.hpp"
#include "coupler/map/network.hpp"

namespace coupler::loader {
namespace {

Watchdog read_watchdog(const Reader& top, Context& context) {
  Watchdog watchdog;
  const auto reader = top.inside("watchdog", "a map with 'timeout'");
  if (!reader) return watchdog;
  if (!reader->has("timeout"))
    context.problems.error(top.find("watchdog")->key_at, "'watchdog' has no 'timeout'",
                           "add 'timeout: 500ms', the longest silence of a client");
  reader->fields(watchdog);
  return watchdog;
}

/// Who lists all of one family means everybody, perhaps, but nobody of the other may connect.
void warn_of_half(const std::vector<std::pair<Network, const Entry*>>& allowed, Context& context) {
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

Span<const std::string_view> read_allow(const Reader& top, Context& context) {
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

}  // namespace

Connection read_connection(const Reader& top, Context& context) {
  Connection connection;
  top.fields(connection);
  if (!connection.address.empty()) {
    if (const auto host = parse_host(connection.address))
      connection.address = *host;
    else
      context.problems.error(top.find("address")->at,
                             fmt::format("'address': '{}' {}", connection.address, host.error().what),
                             host.error().remedy);
  }
  return connection;
}

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

Service read_service(const Reader& top, Context& context) {
  Service service;
  top.fields(service);
  if (const Entry* entry = top.find("listen");
      entry != nullptr && entry->kind == Entry::Kind::scalar && !is_ip_address(entry->text))
    top.wrong("listen", "an IP address of the node");
  service.allow = read_allow(top, context);
  service.watchdog = read_watchdog(top, context);
  return service;
}

}  // namespace coupler::loader
