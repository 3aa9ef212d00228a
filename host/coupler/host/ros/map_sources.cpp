// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/map_sources.hpp"

#include <filesystem>
#include <future>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/backoff.hpp"
#include "coupler/host/core/node_map.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/ros/diagnostics.hpp"
#include "coupler/host/ros/place_check.hpp"
#include "coupler/host/ros/program.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

constexpr auto shutdown_check_interval = std::chrono::milliseconds(50);

using Source = tl::expected<MapSource, int>;
using LogFunction = std::function<void(Level, const std::string&)>;

/// Finds one map at a time. The settings must outlive what it finds.
class MapFinder {
 public:
  MapFinder(const Dialect& dialect, const LogFunction& log, Node* node)
      : dialect_(dialect), log_(log), node_(node) {}

  /// PATH, or NAME=PATH for a device that is not to have its map's name. The result views `entry`.
  Source from_entry(std::string_view entry) {
    const std::size_t equals = entry.find('=');
    const bool is_named = equals < entry.find('/');  // a folder may have '=' in its name
    const std::string_view name = is_named ? entry.substr(0, equals) : std::string_view();
    auto source = from_file(std::string(is_named ? entry.substr(equals + 1) : entry), name);
    if (source && !name.empty()) source->map.name = name;
    return source;
  }

  Source from_settings(const Map* built_in, const Settings& settings) {
    if (built_in != nullptr) {
      if (settings.map)
        return fail(
            wrong_call,
            "this driver has its map built in and takes no other; use coupler_driver for another map");
      return MapSource{nullptr, *built_in};
    }
    if (settings.map && names_a_node(*settings.map)) return from_node_address(*settings.map, settings);
    if (settings.map)
      return from_file(*settings.map, settings.name ? std::string_view(*settings.name) : std::string_view());
    if (settings.address || settings.serial) return from_node({}, settings);
    return fail(
        wrong_call,
        "no map; give one by --map MAP, or --address HOST of a device that serves its map (--help shows "
        "examples)");
  }

  tl::unexpected<int> fail(int exit_code, const std::string& why) {
    log_(Level::error, why);
    return tl::make_unexpected(exit_code);
  }

 private:
  /// `name` is for a map that has none.
  Source from_file(const std::string& path, std::string_view name) {
    const LoadResult loaded = load_map_file(path, LockUse::read, name);
    coupler::print(loaded.diagnostics);
    if (loaded.map) return MapSource{loaded.map, loaded.map->map()};
    explain_relative_path(path);
    return tl::make_unexpected(wrong_input);
  }

  /// Programs of a launch file start in another folder than its own, where a relative path is not found.
  void explain_relative_path(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::path(path).is_absolute() || fs::exists(path, ignored)) return;
    if (path.find(':') != std::string::npos && parse_node_address(node_argument(path)))
      return log_(Level::error, fmt::format("if {0} is a node that serves its map, write tcp://{0}", path));
    log_(Level::error,
         fmt::format("there is no file {}; {}", fs::absolute(path, ignored).string(),
                     fmt::format(fmt::runtime(dialect_.relative_path), fmt::arg("path", path))));
  }

  /// The map that the node serves, if any; an error after a shutdown.
  tl::expected<std::optional<ServedMap>, int> wait_for_map(Link& link, const std::string& where,
                                                           MapDiagnostics& diagnostics) {
    Backoff backoff;
    std::string logged;
    while (!Shutdown::requested) {
      // A device that hangs must not hold up the shutdown for its timeout.
      auto attempt = std::async(std::launch::async, [&link] { return fetch_served_map(link); });
      while (attempt.wait_for(shutdown_check_interval) != std::future_status::ready) {
        if (Shutdown::requested) link.interrupt();
        diagnostics.publish_if_due();
      }
      auto served = attempt.get();
      if (served) return std::move(*served);
      if (Shutdown::requested) break;
      const std::string waiting =
          fmt::format("waiting for the map of {}: {}{}; trying again", where, to_string(served.error()),
                      is_no_right(served.error())
                          ? ": it gives its map only to clients that may read every point; give its map by "
                            "--map MAP, or a certificate whose role has 'read: all'"
                          : "");
      if (waiting != logged) log_(Level::warning, waiting);
      logged = waiting;
      diagnostics.say(Level::warning, waiting);
      const Time again = std::chrono::steady_clock::now() + backoff.next();
      while (!Shutdown::requested && std::chrono::steady_clock::now() < again) {
        diagnostics.publish_if_due();
        std::this_thread::sleep_for(shutdown_check_interval);
      }
    }
    return tl::make_unexpected(0);
  }

  /// The settings override `node`; the map will view both.
  Source from_node(const NodeAddress& node, const Settings& settings) {
    Map asked = found_at({}, node);
    apply(settings, asked);
    if (settings.map) {  // it says whether there is TLS, and at which port
      asked.connection.port = settings.port.value_or(node.port);
      if (node.tls && !asked.connection.tls.present())
        return fail(wrong_call, "tls:// needs certificate, key and ca (or pin): give them as settings");
      if (!node.tls && asked.connection.tls.present())
        return fail(wrong_call, *settings.map + " is without TLS; write tls://, or leave out certificate");
    }
    if (const auto wrong = place_error(settings, asked.connection); !wrong.empty())
      return fail(wrong_call, wrong);
    if (const auto useless = useless_setting(settings, found_at({}, node)); !useless.empty())
      return fail(wrong_call, useless);
    const std::string where = place_text(asked.connection);
    Link link = make_link(asked.connection);
    MapDiagnostics diagnostics(asked.connection, node_);
    diagnostics.say(Level::warning, "waiting for the map of " + where);
    const auto served = wait_for_map(link, where, diagnostics);
    if (!served) return tl::make_unexpected(served.error());
    if (!*served)
      return fail(wrong_input, where + " serves no map: it is a foreign device; give its map by --map MAP");
    const auto owner = load_node_map((*served)->text, (*served)->head, load_served_map);
    if (!owner)
      return fail(wrong_input, fmt::format("the map of {} cannot be used: {}", where, owner.error()));
    diagnostics.say(Level::info, "read from " + where);
    // The place where the node was found counts, not the one in its map.
    Map map = (*owner)->map();
    const Connection its_own = std::exchange(map.connection, asked.connection);
    map.connection.timeout = its_own.timeout;
    map.connection.changed_from(its_own.is_rtu());
    return MapSource{*owner, map};
  }

  Source from_node_address(const std::string& argument, const Settings& settings) {
    const auto node = parse_node_address(argument);
    if (!node)
      return fail(wrong_call, fmt::format("{}: {}; {}", argument, node.error().what, node.error().remedy));
    return from_node(*node, settings);
  }

  const Dialect& dialect_;
  const LogFunction& log_;
  Node* node_;
};

/// Returns what is wrong with settings that name several maps, or an empty text.
std::string find_conflict(const Map* built_in, const Settings& settings, const Dialect& dialect) {
  if (built_in != nullptr)
    return "this driver has its map built in and takes no other; use coupler_driver for other maps";
  if (settings.map) return "both map and maps are given; give one of them";
  if (settings.name || settings.address || settings.port || settings.unit || settings.serial)
    return fmt::format(
        "name, address, port, unit and serial are for one device; with several maps write them into the "
        "maps, "
        "or give them for each device {}",
        dialect.device_setting);
  return {};
}

/// Returns what is wrong with the devices, or an empty text.
std::string find_error(const Devices& devices) {
  std::set<std::string_view> names;
  std::vector<Map> maps;
  for (const auto& [settings, source] : devices) {
    maps.push_back(source.map);
    if (!source.map.connection.present())
      return fmt::format(
          "the map{} has no address; add 'address: HOST' or give --address HOST; for one on a "
          "serial line 'serial: {{device: /dev/ttyUSB0}}' or --serial /dev/ttyUSB0",
          devices.size() > 1 ? fmt::format(" of {}", source.map.name) : "");
    const bool is_broadcast = source.map.connection.is_broadcast();
    const std::string wrong =
        is_broadcast ? broadcast_error(source.map) : place_error(settings, source.map.connection);
    if (!wrong.empty()) return fmt::format("{}: {}", source.map.name, wrong);
    if (!names.insert(source.map.name).second)
      return fmt::format(
          "two devices have the name {}; give one of them another, as in --maps left=a.yaml,right=a.yaml",
          source.map.name);
  }
  return line_conflict(maps);
}

}  // namespace

tl::expected<std::vector<MapSource>, int> find_maps(const Map* built_in, const Settings& settings,
                                                    const Dialect& dialect, const LogFunction& log,
                                                    Node* node) {
  MapFinder finder(dialect, log, node);
  std::vector<MapSource> sources;
  if (settings.maps.empty()) {
    auto source = finder.from_settings(built_in, settings);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
    return sources;
  }
  if (const auto wrong = find_conflict(built_in, settings, dialect); !wrong.empty())
    return finder.fail(wrong_call, wrong);
  for (const std::string& entry : settings.maps) {
    auto source = finder.from_entry(entry);
    if (!source) return tl::make_unexpected(source.error());
    sources.push_back(std::move(*source));
  }
  return sources;
}

bool is_map_of_a_node(const Map* built_in, const Settings& settings) {
  if (built_in != nullptr || !settings.maps.empty()) return false;
  return settings.map ? names_a_node(*settings.map) : settings.address || settings.serial;
}

std::vector<std::string_view> names_of(const std::vector<MapSource>& sources) {
  std::vector<std::string_view> names;
  names.reserve(sources.size());
  for (const MapSource& source : sources) names.push_back(source.map.name);
  return names;
}

tl::expected<Devices, std::string> configure(
    std::vector<MapSource> sources,
    const std::function<tl::expected<Settings, std::string>(std::string_view name)>& settings_of) {
  Devices devices;
  for (MapSource& source : sources) {
    auto settings = settings_of(source.map.name);
    if (!settings) return tl::make_unexpected(settings.error());
    if (const auto useless = useless_setting(*settings, source.map); !useless.empty())
      return tl::make_unexpected(fmt::format("{}: {}", source.map.name, useless));
    DeviceConfig& device = devices.emplace_back(DeviceConfig{std::move(*settings), std::move(source)});
    apply(device.settings, device.source.map);
  }
  if (std::string wrong = find_error(devices); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  return devices;
}

}  // namespace coupler::host
