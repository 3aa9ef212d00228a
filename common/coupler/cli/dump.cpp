// SPDX-License-Identifier: Apache-2.0
#include <fnmatch.h>

#include <memory>
#include <string>

#include <fmt/format.h>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/device_argument.hpp"
#include "coupler/cli/live_device.hpp"

namespace coupler::cli {
namespace {

struct Arguments {
  DeviceArgument device;
  std::vector<std::string> points;
  double every = 0;  ///< s; 0: not given
  bool watch = false;
  bool json = false;
};

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
  const auto device = get_device("dump", arguments.device);
  if (!device) return device.error();
  const Map& map = device->map;
  DumpOptions options;
  auto chosen = choose(map, arguments.points);
  if (!chosen)
    return complain("dump", bad_call, fmt::format("no point matches '{}'", chosen.error()),
                    fmt::format("`coupler export {} --to csv` lists their names", arguments.device.map));
  options.chosen = std::move(*chosen);
  if (arguments.watch) {
    constexpr double usual = 1;
    const std::chrono::duration<double> every(arguments.every > 0 ? arguments.every : usual);
    options.every = std::chrono::duration_cast<std::chrono::nanoseconds>(every);
  }
  options.json = arguments.json;
  return dump(map, options);
}

}  // namespace

void add_dump(Program& program, Exit& exit) {
  auto command = program.add_command(
      "dump", "Read every point of a device and show its value, or why there is none. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
  add_device_options(command, arguments->device);
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
