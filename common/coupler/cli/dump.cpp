// SPDX-License-Identifier: Apache-2.0
#include <fnmatch.h>

#include <memory>
#include <string>

#include <fmt/format.h>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/live_device.hpp"
#include "coupler/cli/map_argument.hpp"
#include "coupler/map/diagnostic.hpp"

namespace coupler::cli {
namespace {

struct Arguments {
  TlsTexts tls;
  std::string map;
  std::string at;
  std::vector<std::string> points;
  double every = 1;  ///< s
  bool watch = false;
  bool json = false;
};

Exit refuse(const std::string& what, const std::string& remedy) {
  return complain("dump", bad_call, what, remedy);
}

/// By point. Every pattern must match: a misspelt one would leave points out without a word.
tl::expected<std::vector<bool>, std::string> choose(const Map& map,
                                                    const std::vector<std::string>& patterns) {
  std::vector<bool> chosen(map.points.size(), patterns.empty());
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (::fnmatch(pattern.c_str(), std::string(map.points[i].name).c_str(), 0) != 0) continue;
      found = chosen[i] = true;
    }
    if (!found) return tl::make_unexpected(pattern);
  }
  return chosen;
}

Exit run(const Arguments& arguments) {
  const MapArgument argument = get_map(arguments.map, arguments.tls);
  print(argument.loaded.diagnostics);
  if (!argument.loaded.map) return argument.exit;
  Map map = argument.map();
  if (any_given(arguments.tls)) {
    if (!map.connection.tls.present() && !map.connection.serial.present() &&
        map.connection.port == modbus::default_port)
      map.connection.port = default_tls_port;
    overlay(map.connection.tls, arguments.tls.view());
    if (const auto problem = tls_problem(map.connection.tls))
      return refuse("TLS needs certificates", *problem);
  }
  const std::string at = node_argument(arguments.at, map.connection);
  if (!arguments.at.empty()) {
    const auto device = parse_node_address(at, map.connection);
    if (!device) return refuse("--at: " + device.error().what, device.error().remedy);
    map = found_at(map, *device);
    if (device->tls && !map.connection.tls.present())
      return refuse("tls:// needs certificates", *tls_problem(map.connection.tls));
  }
  if (!map.connection.present())
    return refuse(
        arguments.map + " does not say where the device is",
        "give --at HOST[:PORT][/UNIT] or --at /dev/ttyUSB0[/UNIT], or `address:` or `serial:` in the map");
  DumpOptions options;
  auto chosen = choose(map, arguments.points);
  if (!chosen)
    return refuse(fmt::format("no point matches '{}'", chosen.error()),
                  fmt::format("`coupler export {} --to csv` lists their names", arguments.map));
  options.chosen = std::move(*chosen);
  if (arguments.watch)
    options.every =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(arguments.every));
  options.json = arguments.json;
  return dump(map, options);
}

}  // namespace

void add_dump(Program& program, Exit& exit) {
  auto command = program.add_command(
      "dump", "Read every point of a device and show its value, or why there is none. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->map, map_help).required().type_name("");
  command
      .add_option("--at", arguments->at,
                  "Where the device is, if not where the map says: HOST[:PORT][/UNIT], or a serial port as "
                  "/dev/ttyUSB0[/UNIT]; parts that are not given are the map's")
      .type_name("PLACE");
  command
      .add_option("--points", arguments->points, "Only points whose names match, as in 'pump_*'; repeatable")
      .delimiter(',')
      .no_extra_values()
      .type_name("GLOB");
  auto watch = command
                   .add_option("--watch", arguments->every,
                               "Repeat every so many seconds, default 1, until Ctrl-C: in place on a "
                               "terminal, else with a line for each change")
                   .optional_value()
                   .in_range(0.05, 86400.0)
                   .type_name("SECONDS");
  command.add_flag("--json", arguments->json,
                   "One JSON object on standard output, for scripts; with --watch one per line");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler dump tcp://raspberrypi\n  coupler dump device.yaml --at 10.0.0.7 --points "
      "'pump_*' --watch 0.5\n"
      "Exit status 3: the device cannot be reached, or a point cannot be read.");
  command.callback([arguments, watch, &exit] {
    arguments->watch = watch.given();
    exit = run(*arguments);
  });
}

}  // namespace coupler::cli
