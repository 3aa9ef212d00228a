// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/live_map.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "coupler/host/core/node_map.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/tools/modbus_client.hpp"
#include "coupler/tools/place_argument.hpp"
#include "coupler/tools/probe_scan.hpp"

namespace coupler::tools {
namespace {

constexpr auto give_a_file = "give the file of its map instead";

using Fetched = host::Result<std::optional<host::ServedMap>>;

Fetched fetch(const Connection& where) {
  host::Link link = host::make_link(where);
  return host::fetch_served_map(link);
}

/// The device can be reached, and perhaps it does not like the question, or has another unit id.
bool is_silent(const host::Error& error) {
  return !std::holds_alternative<host::NotConnected>(error) && !host::has_remedy(error) &&
         (host::exception_in(error) == nullptr || host::is_unit_away(error));
}

tl::expected<MapPtr, Failure> map_in(const Fetched& served, const Connection& where) {
  if (!served && is_no_right(served.error()))
    return fail(failed, "the node gives its map only to clients that may read every point (exception 01)",
                "give the file of its map instead, or a certificate whose role has 'read: all'");
  if (!served && host::exception_in(served.error()) != nullptr)
    return fail(failed, "the node does not give its map: " + host::to_string(served.error()), give_a_file);
  if (!served) {
    std::string remedy = reach_remedy(
        where, served.error(),
        fmt::format("check that a node serves at {}, as unit {}", place_text(where), where.unit));
    if (is_silent(served.error()))
      remedy += fmt::format("; if it is none, `coupler probe {}` says what it answers to",
                            as_argument(node_address_text(where)));
    return fail(failed, "no answer from a node: " + host::to_string(served.error()), remedy);
  }
  if (!*served)
    return fail(bad_input, "a foreign coupler, which serves no map",
                fmt::format("`coupler probe {} --out FILE` drafts one, or give the file of its map",
                            as_argument(node_address_text(where))));
  auto map = host::load_node_map((*served)->text, (*served)->head, load_served_map);
  if (!map) return fail(bad_input, "the node's map cannot be used: " + map.error(), "");
  return *map;
}

}  // namespace

tl::expected<MapPtr, Failure> fetch_live_map(Connection where) {
  where.timeout = std::max(where.timeout, usual_timeout(where.is_rtu()));
  return map_in(fetch(where), where);
}

tl::expected<MapPtr, Failure> fetch_map_if_node(const Connection& where) {
  const Fetched served = fetch(where);
  if (served ? !served->has_value() : is_silent(served.error())) return nullptr;
  if (!served && std::holds_alternative<host::NotConnected>(served.error()))
    return tl::make_unexpected(why_unreachable(served.error(), where));
  return map_in(served, where);
}

}  // namespace coupler::tools
