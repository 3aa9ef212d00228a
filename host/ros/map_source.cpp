// SPDX-License-Identifier: Apache-2.0
#include "host/ros/map_source.hpp"

#include <cstdio>
#include <thread>

#include <fmt/format.h>

#include "common/map/loader/load.hpp"
#include "host/core/backoff.hpp"
#include "host/core/node_map.hpp"
#include "host/modbus/modbus_transport.hpp"

namespace coupler::driver {
namespace {

constexpr int wrong_input = 1;
constexpr int wrong_call = 2;

using Source = tl::expected<MapSource, int>;

void print(std::string_view text) { fmt::print(stderr, "coupler_driver: {}\n", text); }

Source from_file(const std::string& path) {
  const LoadResult loaded = load_map_file(path);
  for (const Diagnostic& diagnostic : loaded.diagnostics) fmt::print(stderr, "{}\n", to_string(diagnostic));
  if (!loaded.map) return tl::make_unexpected(wrong_input);
  return MapSource{loaded.map, loaded.map->map()};
}

/// The head and the map's text as the node has them; nullopt: a foreign coupler.
struct Served {
  identity::Head head;
  std::string text;
};

Result<std::optional<Served>> ask(Transport& transport) {
  if (auto connected = transport.connect(); !connected) return tl::make_unexpected(connected.error());
  const auto head = read_identity(transport);
  if (!head) return tl::make_unexpected(head.error());
  if (!head->has_value()) return std::nullopt;
  auto text = fetch_map_text(transport, (*head)->map_size);
  if (!text) return tl::make_unexpected(text.error());
  return Served{**head, std::move(*text)};
}

std::optional<Served> wait_for(Transport& transport, const std::string& where) {
  Backoff backoff;
  std::string told;
  for (;;) {
    auto served = ask(transport);
    transport.close();
    if (served) return std::move(*served);
    const std::string why = to_string(served.error());
    if (why != told) print(fmt::format("waiting for the map of {}: {}; trying again", where, why));
    told = why;
    std::this_thread::sleep_for(backoff.next());
  }
}

Source from_node(const Settings& settings) {
  Map asked;
  apply(settings, asked);
  const std::string where = fmt::format("{} port {}", asked.connection.address, asked.connection.port);
  ModbusTransport transport(asked.connection);
  const auto served = wait_for(transport, where);
  if (!served) {
    print(where + " serves no map: it is a foreign coupler; give its map by _map:=MAP");
    return tl::make_unexpected(wrong_input);
  }
  const auto owner = load_node_map(served->text, served->head, load_map);
  if (!owner) {
    print(fmt::format("the map of {} cannot be used: {}", where, owner.error()));
    return tl::make_unexpected(wrong_input);
  }
  // Where it was found counts, not where it says it is.
  Map map = (*owner)->map();
  map.connection.address = *settings.address;
  map.connection.port = asked.connection.port;
  map.connection.unit = asked.connection.unit;
  return MapSource{*owner, map};
}

Source find_one(const Map* built_in, const Settings& settings) {
  if (built_in != nullptr) {
    if (settings.map) {
      print("this driver has its map built in and takes no other; use coupler_driver for that");
      return tl::make_unexpected(wrong_call);
    }
    return MapSource{nullptr, *built_in};
  }
  if (settings.map) return from_file(*settings.map);
  if (settings.address) return from_node(settings);
  print(
      "no map; give one by _map:=MAP, or _address:=HOST of a node that serves its map (--help shows "
      "examples)");
  return tl::make_unexpected(wrong_call);
}

/// What is wrong with settings that name several maps, or an empty text.
std::string_view why_not_several(const Map* built_in, const Settings& settings) {
  if (built_in != nullptr) return "this driver has its map built in and takes no other";
  if (settings.map) return "both map and maps are given; give one of them";
  if (settings.name || settings.address || settings.port || settings.unit)
    return "name, address, port and unit are those of one device; with several maps give them in the maps, "
           "or "
           "as parameters ~NAME/address and so on, NAME being the map's name";
  return {};
}

}  // namespace

tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings) {
  std::vector<MapSource> sources;
  if (settings.maps.empty()) {
    auto source = find_one(built_in, settings);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
    return sources;
  }
  if (const auto wrong = why_not_several(built_in, settings); !wrong.empty()) {
    print(wrong);
    return tl::make_unexpected(wrong_call);
  }
  for (const std::string& path : settings.maps) {
    auto source = from_file(path);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
  }
  return sources;
}

}  // namespace coupler::driver
