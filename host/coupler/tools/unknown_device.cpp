// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/unknown_device.hpp"

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/scan/draft.hpp"
#include "coupler/host/scan/recognition.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/live_map.hpp"
#include "coupler/tools/probe_call.hpp"
#include "coupler/tools/probe_report.hpp"
#include "coupler/tools/probe_scan.hpp"

namespace coupler::tools {
namespace {

using std::chrono::milliseconds;

/// Small devices free a connection late.
constexpr milliseconds pauses[] = {milliseconds(250), milliseconds(1000), milliseconds(3000)};

void say(std::string_view command, const std::string& text) {
  fmt::print(stderr, "coupler {}: {}\n", command, printable_lines(text));
}

/// Scans the device. If it refuses a connection over TCP, tries again: it has just been reached.
scan::Findings look(ProbeCall& call) {
  scan::Findings findings = look_at_each_line(call);
  for (const milliseconds pause : pauses) {
    if (!findings.broke_off || findings.requests > 0 || has_remedy(*findings.broke_off) ||
        call.connection.serial.present())
      break;
    std::this_thread::sleep_for(pause);
    findings = look_at_each_line(call);
  }
  return findings;
}

tl::expected<FoundMap, Failure> load(const std::string& text) {
  LoadResult loaded = load_map(text, "the draft");
  if (loaded.map) return FoundMap{loaded.map, loaded.map->map().connection};
  std::string why = "the draft of its map does not load";
  for (const Diagnostic& diagnostic : shortened(std::move(loaded.diagnostics)))
    why += "\n" + to_string(diagnostic);
  return fail(failed, why, "write a map from the device's manual");
}

tl::expected<FoundMap, Failure> found_node(std::string_view command, MapPtr map, const Connection& where) {
  say(command, place_text(where) + " is a node that serves its map");
  return FoundMap{std::move(map), where};
}

tl::expected<FoundMap, Failure> map_of_node(std::string_view command, const Connection& where) {
  auto map = fetch_live_map(where);
  if (!map) return tl::make_unexpected(std::move(map.error()));
  return found_node(command, std::move(*map), where);
}

tl::expected<FoundMap, Failure> map_by_a_scan(std::string_view command, const std::string& place,
                                              ProbeCall& call) {
  const std::string device = place_text(call.connection);
  call.task.ends = scan::Task::Ends::when_known;
  const scan::Findings findings = look(call);
  if (findings.broke_off) return tl::make_unexpected(why_unreachable(*findings.broke_off, call.connection));
  // Ctrl-C ends the search, and any other signal the program.
  const bool shows_enough = call.ended_by == SIGINT && findings.unit && !shows_nothing(findings);
  if (!findings.is_complete && !shows_enough)
    return fail(failed, "it was ended before there was a map", "give a map, or let it look to the end");
  if (!findings.unit) return tl::make_unexpected(why_no_unit(call));
  call.connection.unit = *findings.unit;
  if (findings.node) return map_of_node(command, call.connection);
  const std::string to_file =
      fmt::format("to keep and change its map: coupler probe {} --out FILE", as_argument(place));
  if (findings.recognition) {
    say(command, fmt::format("{} is a {}, by its own registers: {}; {}", device, findings.recognition->kind,
                             channels_text(*findings.recognition), to_file));
    return load(scan::recognised_map(*findings.recognition, call.connection));
  }
  if (shows_nothing(findings))
    return fail(failed, "the device shows nothing, so there is no map",
                fmt::format("`coupler probe {}` says where else to look; or give a map", as_argument(place)));
  say(command, findings.is_complete
                   ? fmt::format("{} is unknown: its points are what can be read there; {}", device, to_file)
                   : fmt::format("{} is unknown, and not all was looked at: its points are what was found so "
                                 "far; to look again and keep it: coupler probe {} --out FILE",
                                 device, as_argument(place)));
  return load(scan::draft_map(findings, call.connection, {}));
}

}  // namespace

tl::expected<FoundMap, Failure> map_of_unknown_device(std::string_view command, const Place& place) {
  auto call = understand({}, place);
  if (!call) return tl::make_unexpected(std::move(call.error()));
  // At a serial port its rate and parity have to be found first.
  if (!place.connection.serial.present()) {
    auto served = fetch_map_if_node(place.connection);
    if (!served) return tl::make_unexpected(std::move(served.error()));
    if (*served != nullptr) return found_node(command, std::move(*served), place.connection);
  }
  say(command,
      fmt::format(
          "{}: finding out what it answers to, which may take minutes; Ctrl-C ends that, and what was "
          "found by then is used",
          place_text(place.connection)));
  return map_by_a_scan(command, *place.text, *call);
}

}  // namespace coupler::tools
