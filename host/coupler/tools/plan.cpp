// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "coupler/plan/picture.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/map_argument.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/plan_report.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {
namespace {

constexpr double most_load_of_a_line = 0.8;

struct Arguments {
  std::string map;
  TlsTexts tls;
  double rtt = 1;  ///< ms
  bool json = false;
  std::string svg;
};

void warn_if_too_much(const std::string& file, const Map& map, const plan::NetworkTiming& timing) {
  const double load = plan::load(plan::make_read_plan(map), timing);
  if (load <= 1 && load > most_load_of_a_line && map.connection.serial.present())
    fmt::print(stderr,
               "{}: warning: the reads need {} of the line's time, which leaves little for writes and for "
               "replies that are slow; lower `rate`, or raise `baud` on both sides\n",
               file, percent(load));
  if (load > 1)
    fmt::print(stderr,
               "{}: warning: the reads need {} of the time, so poll cycles will be skipped; lower `rate`, "
               "for the map "
               "or for points that change slowly, or reduce the number of requests\n",
               file, percent(load));
}

Exit run(const Arguments& arguments) {
  const MapArgument argument = get_map(arguments.map, arguments.tls);
  print(argument.loaded.diagnostics);
  if (!argument.loaded.map) return argument.exit;
  const Map map = argument.map();
  const plan::NetworkTiming timing =
      plan::timing_of(map, std::chrono::duration_cast<std::chrono::nanoseconds>(
                               std::chrono::duration<double, std::milli>(arguments.rtt)));
  if (!arguments.svg.empty()) {
    const std::string picture = plan::picture(map, plan::make_read_plan(map));
    const Exit written = write_beside_map("plan", arguments.map, "--svg", arguments.svg, picture);
    if (written != ok) return written;
  }
  if (arguments.json)
    std::puts(plan_json(arguments.map, map, timing).c_str());
  else
    put(plan_text(arguments.map, map, timing));
  warn_if_too_much(arguments.map, map, timing);
  return ok;
}

}  // namespace

void add_plan(Program& program, Exit& exit) {
  auto command = program.add_command(
      "plan", "Show the requests that read a map, why each ends where it does, and how long they take.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->map, map_help).required().type_name("");
  command
      .add_option(
          "--rtt", arguments->rtt,
          "Milliseconds from a request to its reply, network and device together; default 1. On a serial "
          "line the time of the characters comes on top")
      .positive()
      .type_name("MS");
  command.add_flag("--json", arguments->json, "One JSON object on standard output, for scripts");
  command.add_option("--svg", arguments->svg, "Write a picture of the address spaces").type_name("FILE");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler plan device.yaml --rtt 2.5 --svg device.svg\n  coupler plan raspberrypi:1502\n"
      "The driver makes the same requests. It warns when they do not fit into their time.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
