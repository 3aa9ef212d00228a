// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/generate/output.hpp"
#include "coupler/host/scan/draft.hpp"
#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/recognition.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/live_map.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/probe_call.hpp"
#include "coupler/tools/probe_report.hpp"
#include "coupler/tools/probe_scan.hpp"
#include "coupler/tools/report.hpp"
#include "coupler/tools/save_map.hpp"

namespace coupler::tools {
namespace {

/// Says what a node is, which has been found in place of an unknown device, and saves its map if that is
/// asked for. `report`: what the scan has to say.
Exit tell_of_node(const ProbeArguments& arguments, const std::string& report, const Connection& where) {
  std::FILE* const to = arguments.out == standard_output ? stderr : stdout;
  std::fputs(report.c_str(), to);
  const auto map = fetch_live_map(where);
  if (!map) return complain("probe", map.error());
  if (!arguments.out.empty()) return save_map("probe", arguments.out, (*map)->map(), where);
  const std::string device = as_argument(where);
  fmt::print(to,
             "{}\nNext: `coupler fetch {} -o FILE` saves its map, `coupler dump {}` shows its values; --scan "
             "looks at its addresses all the same\n",
             summary(device, (*map)->map()), device, device);
  return ok;
}

Exit write(const std::string& path, const std::string& text) {
  const bool to_file = path != standard_output;
  const LoadResult loaded = load_map(text, to_file ? path : "<stdout>");
  print(loaded.diagnostics);
  if (!to_file) {
    const Exit written = write_out("probe", path, text);
    return loaded.map ? written : bad_input;
  }
  if (const auto outcome = generate::write_if_changed(path, text); !outcome) {
    put(text);
    return complain("probe", bad_call, outcome.error(), "the draft is on standard output instead");
  }
  if (!loaded.map) return bad_input;
  fmt::print("{}\nNext: give its points names and types, then `coupler plan {}`\n",
             summary(path, loaded.map->map()), path);
  return ok;
}

Exit run(const ProbeArguments& arguments) {
  const auto place = get_place(arguments.host, arguments.tls);
  if (!place) return complain("probe", place.error());
  auto call = understand(arguments, *place);
  if (!call) return complain("probe", call.error());
  if (const auto can = can_make(arguments.out, arguments.force); !can) return complain("probe", can.error());

  const scan::Findings findings = look_at_each_line(*call);
  if (findings.broke_off) complain("probe", why_unreachable(*findings.broke_off, call->connection));
  if (!findings.unit && findings.is_complete) return complain("probe", why_no_unit(*call));
  if (!findings.unit) return failed;

  std::vector<scan::Match> matches;
  for (const scan::KnownValue& known : call->known)
    matches.push_back({known, scan::find_candidates(known, findings.tables)});
  call->connection.unit = *findings.unit;
  const bool to_file = arguments.out != standard_output;
  const std::string report = probe_report(findings, call->task, call->connection, matches);
  if (findings.node && !arguments.scan) return tell_of_node(arguments, report, call->connection);
  std::fputs(report.c_str(), to_file ? stdout : stderr);
  Exit exit = findings.broke_off ? failed : ok;
  if (shows_nothing(findings)) {
    if (arguments.out.empty()) return exit;
    return complain(
        "probe", failed,
        (to_file ? arguments.out : "the draft") + " is not written: a map needs a point, and none was found",
        findings.is_complete
            ? "look elsewhere, as the report says, or write what the device's manual names into a map"
            : "run it again, to its end");
  }
  if (!arguments.out.empty()) {
    const bool has_all = findings.recognition && matches.empty();
    const Exit written =
        write(arguments.out, has_all ? scan::recognised_map(*findings.recognition, call->connection)
                                     : scan::draft_map(findings, call->connection, matches));
    if (written != ok) exit = written;
  }
  return exit;
}

void add_line_options(command_line::Command& command, ProbeArguments& arguments) {
  command
      .add_option("--baud", arguments.bauds,
                  "On a serial line: rates to try (default: 9600,19200,115200,38400,57600,4800)")
      .delimiter(',')
      .type_name("N");
  command.add_option("--parity", arguments.parities, "On a serial line: parities to try (default: none,even)")
      .delimiter(',')
      .type_name("WORD");
}

constexpr const char* example =
    "Example:\n  coupler probe 192.168.1.17 --known voltage=230.4 --known frequency=50.02 --out meter.yaml\n"
    "  coupler probe /dev/ttyUSB0 --baud 9600\n"
    "Ctrl-C ends it and shows what was found so far.";

}  // namespace

void add_probe(Program& program, Exit& exit) {
  auto command = program.add_command(
      "probe",
      "Find out what a device without a map answers to, and draft its map. It reads and never writes.");
  const auto arguments = std::make_shared<ProbeArguments>();
  command.add_option("HOST", arguments->host, place_help).required().type_name("");
  command
      .add_option("--units", arguments->units,
                  "Unit ids to ask, as 1-247 (default: 1, 255, 0; with RTU 1-247)")
      .delimiter(',')
      .type_name("N[-N]");
  const auto from = command.add_option("--from", arguments->from, "First address to look at")
                        .in_range(0, 65535)
                        .show_default()
                        .type_name("N");
  const auto to = command.add_option("--to", arguments->to, "Last address to look at, up to 65535")
                      .in_range(0, 65535)
                      .show_default()
                      .type_name("N");
  command
      .add_option("--stride", arguments->stride,
                  "Where blocks are refused, try one address in N; 1 tries all")
      .in_range(1, 1000)
      .show_default()
      .type_name("N");
  command.add_option("--rate", arguments->rate, "Requests a second, at most")
      .in_range(0.1, 1000.0)
      .show_default()
      .type_name("N");
  command
      .add_option("--timeout", arguments->timeout,
                  "Longest wait for an answer, in seconds; default 1, on a serial line 0.1")
      .in_range(0.01, 60.0)
      .type_name("S");
  add_line_options(command, *arguments);
  command
      .add_option("--known", arguments->known,
                  "A value that the device displays, to search for: 230.4, voltage=230.4, voltage=230.4±2")
      .type_name("[NAME=]VALUE")
      .one_value();
  command
      .add_option("--out", arguments->out,
                  "Write a draft of the map, or the map that a node serves; - is standard output, and the "
                  "report is on standard error then")
      .type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace an existing file");
  command.add_flag(
      "--scan", arguments->scan,
      "Also scan a node that serves its map, as --known, --from and --to do; otherwise that map is "
      "all that is asked for");
  add_tls_options(command, arguments->tls);
  command.footer(example);
  command.callback([arguments, from, to, &exit] {
    // These options can only be meant for a scan.
    if (!arguments->known.empty() || from.given() || to.given()) arguments->scan = true;
    exit = run(*arguments);
  });
}

}  // namespace coupler::tools
