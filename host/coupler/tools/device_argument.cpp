// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/device_argument.hpp"

#include <utility>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/network.hpp"
#include "coupler/tools/unknown_device.hpp"

namespace coupler::tools {
namespace {

/// Returns the map that a device serves, or else one that is found out. Says on standard error, as `command`,
/// which of the two it is.
MapArgument find_map(std::string_view command, const std::string& argument, const TlsTexts& tls) {
  const auto place = std::make_shared<const std::string>(node_argument(argument));
  const auto node = parse_node_address(*place);
  if (!node) return no_map(argument, {bad_call, node.error().what, node.error().remedy});
  MapArgument found{{}, ok, *node, {}, place};
  if (const auto problem = use_tls_options(*node, tls, found.tls)) return no_map(argument, *problem);
  auto map = map_of_unknown_device(command, *place, tls);
  if (!map) {
    const bool is_name = !names_a_node(argument) && !node->serial.present() && !is_ip_address(node->host);
    const std::string what = (is_name ? "no such file, and as a device: " : "") + map.error().what;
    return no_map(argument, {map.error().exit, what, map.error().remedy});
  }
  found.loaded.map = std::move(map->map);
  found.node->unit = map->where.unit;
  found.node->serial = map->where.serial;
  return found;
}

}  // namespace

void add_device_options(command_line::Command& command, DeviceArgument& arguments) {
  if (arguments.may_be_unknown)
    command
        .add_option(
            "MAP|HOST", arguments.map,
            "YAML or JSON file; - is standard input; HOST[:PORT][/UNIT] or /dev/ttyUSB0[/UNIT] is a device, "
            "whose map is found out")
        .required()
        .type_name("");
  else
    command.add_option("MAP", arguments.map, map_help).required().type_name("");
  command
      .add_option(
          "--at", arguments.at,
          "Where the device is, if not where the map says: HOST[:PORT][/UNIT], with tls:// in front or "
          "not, or a serial port as "
          "/dev/ttyUSB0[/UNIT]; parts that are not given are the map's")
      .type_name("PLACE");
  add_tls_options(command, arguments.tls);
}

tl::expected<DeviceMap, Exit> get_device(std::string_view command, const DeviceArgument& arguments) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    return tl::make_unexpected(complain(command, bad_call, what, remedy));
  };
  MapArgument argument = arguments.may_be_unknown && can_be_a_device(arguments.map)
                             ? find_map(command, arguments.map, arguments.tls)
                             : get_map(arguments.map, arguments.tls);
  print(argument.loaded.diagnostics);
  if (!argument.loaded.map) return tl::make_unexpected(argument.exit);
  Map map = argument.map();
  if (any_given(arguments.tls)) {
    if (!map.connection.tls.present() && !map.connection.serial.present() &&
        map.connection.port == modbus::default_port)
      map.connection.port = default_tls_port;
    overlay(map.connection.tls, arguments.tls.view());
    if (const auto problem = tls_problem(map.connection.tls))
      return refuse("TLS needs certificates", *problem);
  }
  const auto at = std::make_shared<const std::string>(node_argument(arguments.at, map.connection));
  if (!arguments.at.empty()) {
    const auto device = parse_node_address(*at, map.connection);
    if (!device) return refuse("--at: " + device.error().what, device.error().remedy);
    map = found_at(map, *device);
    if (device->tls && !map.connection.tls.present())
      return refuse("tls:// needs certificates", *tls_problem(map.connection.tls));
  }
  if (!map.connection.present())
    return refuse(
        arguments.map + " does not say where the device is",
        "give --at HOST[:PORT][/UNIT] or --at /dev/ttyUSB0[/UNIT], or `address:` or `serial:` in the map");
  return DeviceMap{std::move(argument), at, map};
}

}  // namespace coupler::tools
