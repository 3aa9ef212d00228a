// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/report.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/modbus_client.hpp"
#include "coupler/host/cli/probe_call.hpp"
#include "coupler/host/cli/probe_report.hpp"
#include "coupler/host/cli/progress_bar.hpp"
#include "coupler/host/core/steady_clock.hpp"

namespace coupler::cli {
namespace {

namespace fs = std::filesystem;

scan::Findings look(const ProbeCall& call) {
  ModbusClient client(call.connection);
  host::SteadyClock clock;
  ProgressBar progress;
  const Interruption interruption([&] {
    progress.end();
    clock.stop();
    client.interrupt();
  });
  return scan::scan(call.task, client, clock, progress);
}

/// Before anything is asked: a draft that cannot be written would cost a scan.
tl::expected<void, WrongCall> can_write(const ProbeArguments& arguments) {
  if (arguments.out.empty()) return {};
  const fs::path path(arguments.out);
  std::error_code ignored;
  if (!arguments.force && fs::exists(path, ignored))
    return tl::make_unexpected(WrongCall{arguments.out + " is there already",
                                         "name another file with --out, or replace it with --force"});
  if (path.has_parent_path() && !fs::is_directory(path.parent_path(), ignored))
    return tl::make_unexpected(
        WrongCall{path.parent_path().string() + " is not a folder", "make it, or name another with --out"});
  return {};
}

Exit write(const std::string& path, const std::string& text) {
  const LoadResult loaded = load_map(text, path);
  print(loaded.diagnostics);
  if (const auto outcome = generate::write_if_changed(path, text); !outcome) {
    std::fputs(text.c_str(), stdout);
    return complain("probe", bad_call, outcome.error(), "the draft is on standard output instead");
  }
  if (!loaded.map) return bad_input;
  fmt::print("{}\nNext: give its points names and types, then `coupler plan {}`\n",
             summary(path, loaded.map->map()), path);
  return ok;
}

Exit run(const ProbeArguments& arguments) {
  const auto understood = understand(arguments);
  if (!understood) return complain("probe", bad_call, understood.error().what, understood.error().remedy);
  ProbeCall& call = **understood;
  if (const auto can = can_write(arguments); !can)
    return complain("probe", bad_call, can.error().what, can.error().remedy);

  const scan::Findings findings = look(call);
  if (findings.broke_off)
    complain("probe", failed, host::to_string(*findings.broke_off),
             "see that the device is on, the port right, and no other client has its last connection");
  if (!findings.unit && findings.is_complete)
    return complain("probe", failed,
                    fmt::format("a server is there, but none of {} units answers", call.task.units.size()),
                    "give its unit id, as HOST/17, or try all with --units 0-247,255");
  if (!findings.unit) return failed;

  std::vector<scan::Match> matches;
  for (const scan::KnownValue& known : call.known)
    matches.push_back({known, scan::find_candidates(known, findings.tables)});
  call.connection.unit = *findings.unit;
  std::fputs(probe_report(findings, call.task, call.connection, matches).c_str(), stdout);
  Exit exit = findings.broke_off ? failed : ok;
  if (!arguments.out.empty()) {
    const Exit written = write(arguments.out, scan::draft_map(findings, call.connection, matches));
    if (written != ok) exit = written;
  }
  return exit;
}

}  // namespace

void add_probe(Program& program, Exit& exit) {
  auto command = program.add_command(
      "probe",
      "Find out what a device answers to that has no map, and draft one. It reads and never writes.");
  const auto arguments = std::make_shared<ProbeArguments>();
  command.add_option("HOST", arguments->host, "HOST[:PORT][/UNIT], with tcp:// in front or not")
      .required()
      .type_name("");
  command.add_option("--units", arguments->units, "Unit ids to ask, as 1-247 (default: 1, 255, 0)")
      .delimiter(',')
      .type_name("N[-N]");
  command.add_option("--from", arguments->from, "First address to look at")
      .in_range(0, 65535)
      .show_default()
      .type_name("N");
  command.add_option("--to", arguments->to, "Last address to look at, up to 65535")
      .in_range(0, 65535)
      .show_default()
      .type_name("N");
  command
      .add_option("--stride", arguments->stride,
                  "Where blocks are refused, try one address in so many; 1 tries all")
      .in_range(1, 1000)
      .show_default()
      .type_name("N");
  command.add_option("--rate", arguments->rate, "Requests a second, at most")
      .in_range(0.1, 1000.0)
      .show_default()
      .type_name("N");
  command.add_option("--timeout", arguments->timeout, "Longest wait for an answer, in seconds")
      .in_range(0.01, 60.0)
      .show_default()
      .type_name("S");
  command
      .add_option("--known", arguments->known,
                  "A value that the device shows, to be searched for: 230.4, voltage=230.4, voltage=230.4±2")
      .type_name("[NAME=]VALUE")
      .one_value();
  command.add_option("--out", arguments->out, "Write a draft of the map").type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace a file that is there");
  command.footer(
      "Example:\n  coupler probe 192.168.1.17 --known voltage=230.4 --known frequency=50.02 --out "
      "meter.yaml\n"
      "Ctrl-C ends it and shows what was found so far.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
