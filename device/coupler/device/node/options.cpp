// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/options.hpp"

#include <filesystem>

#include "coupler/base/version.hpp"
#include "coupler/command_line/command_line.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::device {

std::string address_for(const Map& map, const Options& options) {
  if (!options.listen.empty()) return options.listen;
  if (!map.service.listen.empty()) return std::string(map.service.listen);
  return options.simulated ? "127.0.0.1" : "";
}

namespace {

void add_replay_options(command_line::Program& app, ReplayArguments& replay) {
  const auto file =
      app.add_option("--replay", replay.file,
                     "With --sim: every point follows a recording (`coupler record`), whose map is "
                     "served if MAP is not given; a point that a client writes is the client's from then "
                     "on, and is compared. The node ends with it (exit status 1: there were differences)")
          .type_name("FILE");
  app.add_option("--speed", replay.speed, "Play it so many times as fast")
      .in_range(0.01, 1000.0)
      .type_name("N")
      .needs(file);
  app.add_flag("--loop", replay.loop, "Play it again and again").needs(file);
  app.add_option(
         "--from", replay.from,
         "Begin at this moment of the recording: 2026-11-24T15:00:00Z, or a local time of its first day, as "
         "15:00")
      .type_name("TIME")
      .needs(file);
  app.add_flag("--no-faults", replay.no_faults,
               "Play no exceptions, and no times at which the device was silent")
      .needs(file);
  app.add_option(
         "--tolerance", replay.tolerance,
         "How many seconds a write may be from the recorded one (default: two of the point's periods)")
      .in_range(0.0, 3600.0)
      .type_name("S")
      .needs(file);
  app.add_option("--points", replay.points, "Compare only points whose names match, as 'pump_*'; repeatable")
      .delimiter(',')
      .no_extra_values()
      .type_name("GLOB")
      .needs(file);
}

}  // namespace

std::variant<Options, int> parse_options(int argc, char** argv, MapSource source) {
  const std::string program = std::filesystem::path(argc > 0 ? argv[0] : "coupler-node").filename();
  const std::string map = source == MapSource::argument ? " device.yaml" : "";
  Options options;
  command_line::Program app(
      "Serves the points of a map as a Modbus/TCP device: GPIO lines, or simulated ones.", program);
  app.version(program + " " + std::string(version));
  app.propose(nearest);
  app.footer("Example, without hardware, for any Modbus client on this machine:\n  " + program + map +
             " --sim --port 1502" +
             (source == MapSource::argument
                  ? "\nSIGHUP makes it read MAP again; one that cannot be served is refused."
                  : ""));
  if (source == MapSource::argument) {
    const auto file = app.add_option("MAP", options.map, "The map file, YAML or JSON; - is standard input");
    app.add_option("--reload", options.reload,
                   "Instead: make the coupler-node with this process id read its map again, wait, and print "
                   "the result (exit status 0: it serves the new map, 1: refused)")
        .type_name("PID")
        .excludes(file);
    app.callback([&options, file] {
      if (options.map.empty() && options.reload == 0 && options.replay.file.empty()) file.refuse_missing();
    });
  }
  app.add_option(
      "--listen", options.listen,
      "IP address to listen on (default: the map's 'listen', or every interface; with --sim 127.0.0.1)");
  app.add_option("--port", options.port, "TCP port (default: the map's, usually 502; 0: any free one)");
  app.add_option("--tls-port", options.tls_port,
                 "TCP port for TLS, if the map has that (default: the map's, usually 802; 0: any free one)");
  app.add_flag("--sim", options.simulated,
               "Simulate the hardware, wired as the map's sim: section says; `coupler panel --field --write` "
               "sets inputs");
  app.add_flag("--realtime", options.realtime,
               "Run ahead of other programs (SCHED_FIFO) with locked memory; exit with status 3 if the "
               "system refuses that");
  if (source == MapSource::argument) add_replay_options(app, options.replay);
  if (const auto done = app.parse(argc, argv)) return *done;
  return options;
}

}  // namespace coupler::device
