// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/map_source.hpp"

#include <cstdio>
#include <filesystem>
#include <future>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "coupler/host/core/node_map.hpp"
#include "coupler/host/core/schedule.hpp"
#include "coupler/host/modbus/modbus_transport.hpp"
#include "coupler/host/ros/ending.hpp"
#include "coupler/host/ros/program.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

constexpr auto look = std::chrono::milliseconds(50);  ///< how long an end may wait

using Source = tl::expected<MapSource, int>;

/// A look at one place after the other. The settings outlive what it finds.
class Search {
 public:
  Search(const Dialect& dialect, const Say& say) : dialect_(dialect), say_(say) {}

  /// PATH, or NAME=PATH for a device that is not to have its map's name. The result views `entry`.
  Source in_entry(std::string_view entry) {
    const std::size_t equals = entry.find('=');
    const bool is_named = equals < entry.find('/');  // a folder may have '=' in its name
    const std::string_view name = is_named ? entry.substr(0, equals) : std::string_view();
    auto source = in_file(std::string(is_named ? entry.substr(equals + 1) : entry), name);
    if (source && !name.empty()) source->map.name = name;
    return source;
  }

  Source in_settings(const Map* built_in, const Settings& settings) {
    if (built_in != nullptr) {
      if (settings.map)
        return none(wrong_call,
                    "this driver has its map built in and takes no other; use coupler_driver for that");
      return MapSource{nullptr, *built_in};
    }
    if (settings.map && names_a_node(*settings.map)) return in_named_node(*settings.map, settings);
    if (settings.map)
      return in_file(*settings.map, settings.name ? std::string_view(*settings.name) : std::string_view());
    if (settings.address) return in_node(settings, *settings.address);
    return none(
        wrong_call,
        "no map; give one by --map MAP, or --address HOST of a node that serves its map (--help shows "
        "examples)");
  }

  tl::unexpected<int> none(int exit_code, const std::string& why) {
    say_(Level::error, why);
    return tl::make_unexpected(exit_code);
  }

 private:
  /// `name` is that of a map that says none.
  Source in_file(const std::string& path, std::string_view name) {
    const LoadResult loaded = load_map_file(path, LockUse::read, name);
    coupler::print(loaded.diagnostics);
    if (loaded.map) return MapSource{loaded.map, loaded.map->map()};
    explain_relative(path);
    return tl::make_unexpected(wrong_input);
  }

  /// A relative path that leads nowhere: a launch has its programs start in another folder than its own.
  void explain_relative(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::path(path).is_absolute() || fs::exists(path, ignored)) return;
    say_(Level::error,
         fmt::format("a relative path counts from {}; {}", fs::current_path(ignored).string(),
                     fmt::format(fmt::runtime(dialect_.relative_path), fmt::arg("path", path))));
  }

  /// What the node serves, if anything; an error once the wait is ended.
  tl::expected<std::optional<ServedMap>, int> wait_for(Transport& transport, const std::string& where) {
    Backoff backoff;
    std::string told;
    while (!Ending::asked) {
      // A device that hangs must not hold up the end for its timeout.
      auto attempt = std::async(std::launch::async, [&transport] { return fetch_served_map(transport); });
      while (attempt.wait_for(look) != std::future_status::ready)
        if (Ending::asked) transport.interrupt();
      auto served = attempt.get();
      if (served) return std::move(*served);
      if (Ending::asked) break;
      const std::string why = to_string(served.error());
      if (why != told)
        say_(Level::warning, fmt::format("waiting for the map of {}: {}; trying again", where, why));
      told = why;
      const Time again = std::chrono::steady_clock::now() + backoff.next();
      while (!Ending::asked && std::chrono::steady_clock::now() < again) std::this_thread::sleep_for(look);
    }
    return tl::make_unexpected(0);
  }

  /// `address` stays where it is: the map will view it.
  Source in_node(const Settings& settings, std::string_view address) {
    Map asked;
    apply(settings, asked);
    asked.connection.address = address;
    const std::string where = fmt::format("{} port {}", asked.connection.address, asked.connection.port);
    ModbusTransport transport(asked.connection);
    const auto served = wait_for(transport, where);
    if (!served) return tl::make_unexpected(served.error());
    if (!*served)
      return none(wrong_input, where + " serves no map: it is a foreign coupler; give its map by --map MAP");
    const auto owner = load_node_map((*served)->text, (*served)->head, load_served_map);
    if (!owner)
      return none(wrong_input, fmt::format("the map of {} cannot be used: {}", where, owner.error()));
    // Where it was found counts, not where it says it is.
    Map map = (*owner)->map();
    map.connection.address = address;
    map.connection.port = asked.connection.port;
    map.connection.unit = asked.connection.unit;
    return MapSource{*owner, map};
  }

  /// tcp://HOST:PORT/UNIT in place of a file; it says the same as address, port and unit, which override it.
  Source in_named_node(const std::string& argument, const Settings& settings) {
    const auto node = parse_node_address(argument);
    if (!node)
      return none(wrong_call, fmt::format("{}: {}; {}", argument, node.error().what, node.error().remedy));
    Settings named;
    named.port = node->port;
    named.unit = node->unit;
    return in_node(overlay(named, settings), settings.address ? *settings.address : node->host);
  }

  const Dialect& dialect_;
  const Say& say_;
};

/// What is wrong with settings that name several maps, or an empty text.
std::string why_not_several(const Map* built_in, const Settings& settings, const Dialect& dialect) {
  if (built_in != nullptr) return "this driver has its map built in and takes no other";
  if (settings.map) return "both map and maps are given; give one of them";
  if (settings.name || settings.address || settings.port || settings.unit)
    return fmt::format(
        "name, address, port and unit are those of one device; with several maps give them in the maps, {}",
        dialect.device_setting);
  return {};
}

}  // namespace

tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings,
                                                    const Dialect& dialect, const Say& say) {
  Search places(dialect, say);
  std::vector<MapSource> sources;
  if (settings.maps.empty()) {
    auto source = places.in_settings(built_in, settings);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
    return sources;
  }
  if (const auto wrong = why_not_several(built_in, settings, dialect); !wrong.empty())
    return places.none(wrong_call, wrong);
  for (const std::string& entry : settings.maps) {
    auto source = places.in_entry(entry);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
  }
  return sources;
}

bool is_map_of_a_node(const Map* built_in, const Settings& settings) {
  if (built_in != nullptr || !settings.maps.empty()) return false;
  return settings.map ? names_a_node(*settings.map) : settings.address.has_value();
}

}  // namespace coupler::host
