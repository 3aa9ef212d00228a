// SPDX-License-Identifier: Apache-2.0
#include "host/ros/map_source.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "common/map/loader/load.hpp"
#include "common/map/loader/print.hpp"
#include "common/map/node_address.hpp"
#include "host/core/backoff.hpp"
#include "host/core/node_map.hpp"
#include "host/modbus/modbus_transport.hpp"
#include "host/ros/ros_log.hpp"

namespace coupler::driver {
namespace {

constexpr int wrong_input = 1;
constexpr int wrong_call = 2;

using Source = tl::expected<MapSource, int>;

/// A relative path that leads nowhere: roslaunch has its programs start in another folder than its own.
void explain_relative(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::path(path).is_absolute() || fs::exists(path, ignored)) return;
  print(fmt::format(
      "a relative path counts from {}; roslaunch starts programs there (in ROS_HOME): give the whole path, "
      "as in map:=$PWD/{} or $(find PACKAGE)/{}",
      fs::current_path(ignored).string(), path, path));
}

/// `name` is that of a map that says none.
Source from_file(const std::string& path, std::string_view name) {
  const LoadResult loaded = load_map_file(path, LockUse::read, name);
  coupler::print(loaded.diagnostics);
  if (!loaded.map) explain_relative(path);
  if (!loaded.map) return tl::make_unexpected(wrong_input);
  return MapSource{loaded.map, loaded.map->map()};
}

/// PATH, or NAME=PATH for a device that is not to have its map's name. The result views `entry`.
Source from_entry(std::string_view entry) {
  const std::size_t equals = entry.find('=');
  const bool is_named = equals < entry.find('/');  // a folder may have '=' in its name
  const std::string_view name = is_named ? entry.substr(0, equals) : std::string_view();
  auto source = from_file(std::string(is_named ? entry.substr(equals + 1) : entry), name);
  if (source && !name.empty()) source->map.name = name;
  return source;
}

std::optional<ServedMap> wait_for(Transport& transport, const std::string& where) {
  Backoff backoff;
  std::string told;
  for (;;) {
    auto served = fetch_served_map(transport);
    if (served) return std::move(*served);
    const std::string why = to_string(served.error());
    if (why != told) print(fmt::format("waiting for the map of {}: {}; trying again", where, why));
    told = why;
    std::this_thread::sleep_for(backoff.next());
  }
}

/// `address` stays where it is: the map will view it.
Source from_node(const Settings& settings, std::string_view address) {
  Map asked;
  apply(settings, asked);
  asked.connection.address = address;
  const std::string where = fmt::format("{} port {}", asked.connection.address, asked.connection.port);
  ModbusTransport transport(asked.connection);
  const auto served = wait_for(transport, where);
  if (!served) {
    print(where + " serves no map: it is a foreign coupler; give its map by _map:=MAP");
    return tl::make_unexpected(wrong_input);
  }
  const auto owner = load_node_map(served->text, served->head, load_served_map);
  if (!owner) {
    print(fmt::format("the map of {} cannot be used: {}", where, owner.error()));
    return tl::make_unexpected(wrong_input);
  }
  // Where it was found counts, not where it says it is.
  Map map = (*owner)->map();
  map.connection.address = address;
  map.connection.port = asked.connection.port;
  map.connection.unit = asked.connection.unit;
  return MapSource{*owner, map};
}

/// tcp://HOST:PORT/UNIT in place of a file; it says the same as address, port and unit, which override it.
Source from_named_node(const std::string& argument, const Settings& settings) {
  const auto node = parse_node_address(argument);
  if (!node) {
    print(fmt::format("{}: {}; {}", argument, node.error().what, node.error().remedy));
    return tl::make_unexpected(wrong_call);
  }
  Settings named;
  named.port = node->port;
  named.unit = node->unit;
  return from_node(overlay(named, settings), settings.address ? *settings.address : node->host);
}

Source find_one(const Map* built_in, const Settings& settings) {
  if (built_in != nullptr) {
    if (settings.map) {
      print("this driver has its map built in and takes no other; use coupler_driver for that");
      return tl::make_unexpected(wrong_call);
    }
    return MapSource{nullptr, *built_in};
  }
  if (settings.map && names_a_node(*settings.map)) return from_named_node(*settings.map, settings);
  if (settings.map)
    return from_file(*settings.map, settings.name ? std::string_view(*settings.name) : std::string_view());
  if (settings.address) return from_node(settings, *settings.address);
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
           "as in _NAME/address:=HOST (NAME being the map's name), or as a parameter ~NAME/address";
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
  for (const std::string& entry : settings.maps) {
    auto source = from_entry(entry);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
  }
  return sources;
}

}  // namespace coupler::driver
