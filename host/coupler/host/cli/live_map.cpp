// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/live_device.hpp"

#include <string>

#include <fmt/format.h>

#include "coupler/host/cli/modbus_client.hpp"
#include "coupler/host/core/node_map.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

constexpr auto give_a_file = "give the file of its map instead";

tl::unexpected<NoLiveMap> none(Exit exit, std::string what, std::string remedy) {
  return tl::make_unexpected(NoLiveMap{exit, std::move(what), std::move(remedy)});
}

/// A node knows how to give its map.
bool is_no_right(const host::Error& error) {
  const auto* exception = host::exception_in(error);
  return exception != nullptr && exception->code == modbus::Exception::illegal_function;
}

}  // namespace

tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& where) {
  const auto transport = host::make_transport(where);
  const auto served = host::fetch_served_map(*transport);
  if (!served && is_no_right(served.error()))
    return none(failed, "the node gives its map only to clients that may read every point (exception 01)",
                "give the file of its map instead, or a certificate whose role has 'read: all'");
  if (!served && host::exception_in(served.error()) != nullptr)
    return none(failed, "the node does not give its map: " + host::to_string(served.error()), give_a_file);
  if (!served)
    return none(failed, "no answer from a node: " + host::to_string(served.error()),
                reach_remedy(where, std::holds_alternative<host::Timeout>(served.error()),
                             fmt::format("check that a node serves at {}, as unit {}", place_text(where),
                                         where.unit)));
  if (!*served) return none(bad_input, "a foreign coupler, which serves no map", give_a_file);
  auto map = host::load_node_map((*served)->text, (*served)->head, load_served_map);
  if (!map) return none(bad_input, "the node's map cannot be used: " + map.error(), give_a_file);
  return *map;
}

}  // namespace coupler::cli
