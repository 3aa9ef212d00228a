// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/device_argument.hpp"

#include <utility>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/network.hpp"
#include "coupler/tools/unknown_device.hpp"

namespace coupler::tools {
void add_device_options(command_line::Command& command, DeviceArgument& arguments) {
  command
      .add_option(
          "MAP|HOST", arguments.map,
          "YAML or JSON file; - is standard input; HOST[:PORT][/UNIT] or /dev/ttyUSB0[/UNIT] is a device, "
          "whose map is found out")
      .required()
      .type_name("");
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
  MapArgument argument = get_map(arguments.map, arguments.tls, LockUse::read, [command](const Place& place) {
    return map_of_unknown_device(command, place);
  });
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
    Connection usual = map.connection;
    if (!starts_with(*at, "tls://")) usual.port = port_without_tls(map);
    const auto device = parse_node_address(*at, usual);
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
