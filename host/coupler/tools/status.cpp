// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/node_address.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/modbus_client.hpp"
#include "coupler/tools/node_status.hpp"
#include "coupler/tools/place_argument.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  std::vector<std::string> hosts;
  TlsTexts tls;
  double timeout = 1;  ///< s
  bool json = false;
};

Exit ask(Connection connection, const Arguments& arguments) {
  connection.timeout = std::chrono::milliseconds(static_cast<long>(arguments.timeout * 1000));
  host::Link link = host::make_link(connection);
  const NodeStatus status = read_status(
      link, [&](modbus::ReadDeviceIdentification wanted) { return read_identification(link, wanted); });
  std::fputs(
      (arguments.json ? status_json(status, connection) + "\n" : status_text(status, connection)).c_str(),
      stdout);
  std::fflush(stdout);
  const std::string device = node_address_text(connection);
  if (status.error)
    return complain("status", failed, device + ": " + to_string(*status.error),
                    reach_remedy(connection, *status.error,
                                 "check that a node serves there, with this unit id, and that its "
                                 "'allow' lets this machine in"));
  if (!status.report)
    return complain("status", bad_input, device + " is a foreign coupler: it has no identity area",
                    "`coupler dump` shows its values if you have its map, `coupler probe` looks into it");
  return ok;
}

/// The devices in turn. A place that is wrong is told before any of them is asked.
Exit run(const Arguments& arguments) {
  std::vector<Place> places;
  for (const std::string& host : arguments.hosts) {
    auto place = get_place(host, arguments.tls);
    if (!place) return complain("status", place.error());
    places.push_back(*std::move(place));
  }
  Exit exit = ok;
  for (const Place& place : places) exit = std::max(exit, ask(place.connection, arguments));
  return exit;
}

}  // namespace

void add_status(Program& program, Exit& exit) {
  auto command = program.add_command(
      "status",
      "Show what a node says about itself: machine, map, watchdog, statistics. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("HOST", arguments->hosts, place_help).required().type_name("");
  command.add_option("--timeout", arguments->timeout, "Longest wait for an answer, in seconds")
      .in_range(0.01, 60.0)
      .show_default()
      .type_name("S");
  command.add_flag("--json", arguments->json,
                   "One JSON object on standard output for each device, on a line of its own, for scripts");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler status raspberrypi\n  coupler status 10.0.0.7:1502/1 10.0.0.8 --json\n"
      "Exit status 1: a foreign coupler; 3: no answer; of several devices the highest one counts.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
