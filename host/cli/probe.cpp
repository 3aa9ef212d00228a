// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <tl/expected.hpp>

#include "common/cli/commands.hpp"
#include "common/cli/report.hpp"
#include "common/generate/output.hpp"
#include "common/map/loader/scalar.hpp"
#include "common/map/node_address.hpp"
#include "host/cli/interruption.hpp"
#include "host/cli/modbus_master.hpp"
#include "host/cli/probe_report.hpp"
#include "host/cli/survey_progress.hpp"
#include "host/core/steady_clock.hpp"

namespace coupler::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string host;
  std::vector<std::string> units;
  std::uint32_t from = 0;
  std::uint32_t to = 9999;
  std::uint32_t stride = survey::Task{{}, modbus::Range::of(0, 1)}.stride;
  double rate = survey::Task{{}, modbus::Range::of(0, 1)}.rate;
  double timeout = 1;
  std::vector<std::string> known;
  std::string out;
  bool force = false;
};

/// What the arguments mean.
struct Call {
  std::string address;  ///< what `connection` is a view of
  Connection connection;
  survey::Task task;
  std::vector<survey::KnownValue> known;
};

Exit complain(Exit exit, std::string_view what, std::string_view remedy) {
  fmt::print(stderr, "coupler probe: error: {}; {}\n", what, remedy);
  return exit;
}

/// Units on Modbus/TCP; 248 to 254 are reserved.
bool is_unit(std::uint64_t unit) { return unit <= 247 || unit == 255; }

/// "5" or "1-247".
bool add_units(std::string_view text, std::vector<std::uint8_t>& units) {
  const auto dash = text.find('-');
  const auto first = loader::parse_unsigned(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : loader::parse_unsigned(text.substr(dash + 1));
  if (!first || !last || *first > *last || !is_unit(*first) || !is_unit(*last)) return false;
  for (auto unit = *first; unit <= *last; ++unit)
    if (is_unit(unit)) units.push_back(static_cast<std::uint8_t>(unit));
  return true;
}

using Wrong = std::pair<std::string, std::string>;  ///< what, remedy

tl::expected<std::vector<std::uint8_t>, Wrong> units_of(const Arguments& arguments, const NodeAddress& where,
                                                        bool has_unit) {
  std::vector<std::uint8_t> units;
  for (const std::string& text : arguments.units)
    if (!add_units(text, units))
      return tl::make_unexpected(
          Wrong{fmt::format("'{}' is no unit id", text), "give 0 … 247 or 255, as --units 1-10,255"});
  if (!units.empty()) return units;
  if (has_unit && !is_unit(where.unit))
    return tl::make_unexpected(Wrong{fmt::format("unit {} is reserved", where.unit), "give 0 … 247 or 255"});
  if (has_unit) return std::vector<std::uint8_t>{where.unit};
  return std::vector<std::uint8_t>{1, 255, 0};
}

tl::expected<std::vector<survey::KnownValue>, Wrong> known_values(const std::vector<std::string>& texts) {
  std::vector<survey::KnownValue> known;
  for (const std::string& text : texts) {
    auto value = survey::parse_known_value(text);
    if (!value) return tl::make_unexpected(Wrong{"--known: " + value.error(), "see `coupler probe --help`"});
    for (const survey::KnownValue& other : known)
      if (!other.name.empty() && other.name == value->name)
        return tl::make_unexpected(
            Wrong{fmt::format("two values are named '{}'", other.name), "give each --known its own name"});
    known.push_back(std::move(*value));
  }
  return known;
}

tl::expected<std::unique_ptr<Call>, Wrong> understand(const Arguments& arguments) {
  auto call =
      std::make_unique<Call>(Call{names_a_node(arguments.host) ? arguments.host : "tcp://" + arguments.host,
                                  {},
                                  {{}, modbus::Range::of(0, 1), arguments.stride, arguments.rate},
                                  {}});
  const auto where = parse_node_address(call->address);
  if (!where) return tl::make_unexpected(Wrong{where.error().what, where.error().remedy});
  if (arguments.from > arguments.to)
    return tl::make_unexpected(
        Wrong{fmt::format("--from {} is behind --to {}", arguments.from, arguments.to), "exchange them"});
  const auto slash = call->address.find('/', std::string("tcp://").size());
  auto units = units_of(arguments, *where, slash != std::string::npos && slash + 1 < call->address.size());
  if (!units) return tl::make_unexpected(units.error());
  auto known = known_values(arguments.known);
  if (!known) return tl::make_unexpected(known.error());
  call->connection = {where->host, where->port, where->unit,
                      std::chrono::milliseconds(static_cast<long>(arguments.timeout * 1000))};
  call->task.units = std::move(*units);
  call->task.window = modbus::Range::of(arguments.from, arguments.to - arguments.from + 1);
  call->known = std::move(*known);
  return call;
}

survey::Findings look(const Call& call) {
  ModbusMaster master(call.connection);
  driver::SteadyClock clock;
  SurveyProgress progress;
  const Interruption interruption([&] {
    progress.end();
    clock.stop();
    master.interrupt();
  });
  return survey::survey(call.task, master, clock, progress);
}

/// Before anything is asked: a draft that cannot be written would cost a survey.
tl::expected<void, Wrong> can_write(const Arguments& arguments) {
  if (arguments.out.empty()) return {};
  const fs::path path(arguments.out);
  std::error_code ignored;
  if (!arguments.force && fs::exists(path, ignored))
    return tl::make_unexpected(Wrong{arguments.out + " is there already",
                                     "name another file with --out, or replace it with --force"});
  if (path.has_parent_path() && !fs::is_directory(path.parent_path(), ignored))
    return tl::make_unexpected(
        Wrong{path.parent_path().string() + " is not a folder", "make it, or name another with --out"});
  return {};
}

Exit write(const std::string& path, const std::string& text) {
  const LoadResult loaded = load_map(text, path);
  print(loaded.diagnostics);
  if (const auto outcome = generate::write_if_changed(path, text); !outcome) {
    std::fputs(text.c_str(), stdout);
    return complain(bad_call, outcome.error(), "the draft is on standard output instead");
  }
  if (!loaded.map) return bad_input;
  fmt::print("{}\nNext: give its points names and types, then `coupler plan {}`\n",
             summary(path, loaded.map->map()), path);
  return ok;
}

Exit run(const Arguments& arguments) {
  const auto understood = understand(arguments);
  if (!understood) return complain(bad_call, understood.error().first, understood.error().second);
  Call& call = **understood;
  if (const auto can = can_write(arguments); !can)
    return complain(bad_call, can.error().first, can.error().second);

  const survey::Findings findings = look(call);
  if (findings.broke_off)
    complain(failed, driver::to_string(*findings.broke_off),
             "see that the device is on, the port right, and no other master has its last connection");
  if (!findings.unit && findings.is_complete)
    return complain(failed,
                    fmt::format("a server is there, but none of {} units answers", call.task.units.size()),
                    "give its unit id, as HOST/17, or try all with --units 0-247,255");
  if (!findings.unit) return failed;

  std::vector<survey::Match> matches;
  for (const survey::KnownValue& known : call.known)
    matches.push_back({known, survey::find_candidates(known, findings.tables)});
  call.connection.unit = *findings.unit;
  std::fputs(probe_report(findings, call.task, call.connection, matches).c_str(), stdout);
  Exit exit = findings.broke_off ? failed : ok;
  if (!arguments.out.empty()) {
    const Exit written = write(arguments.out, survey::draft_map(findings, call.connection, matches));
    if (written != ok) exit = written;
  }
  return exit;
}

}  // namespace

void add_probe(CLI::App& program, Exit& exit) {
  auto* command = program.add_subcommand(
      "probe",
      "Find out what a device answers to that has no map, and draft one. It reads and never writes.");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("HOST", arguments->host, "HOST[:PORT][/UNIT], with tcp:// in front or not")
      ->required()
      ->type_name("");
  command->add_option("--units", arguments->units, "Unit ids to ask, as 1-247 (default: 1, 255, 0)")
      ->delimiter(',')
      ->type_name("N[-N]");
  command->add_option("--from", arguments->from, "First address to look at")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--to", arguments->to, "Last address to look at, up to 65535")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--stride", arguments->stride,
                   "Where blocks are refused, try one address in so many; 1 tries all")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--rate", arguments->rate, "Requests a second, at most")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--timeout", arguments->timeout, "Longest wait for an answer, in seconds")
      ->check(CLI::Range(0.01, 60.0))
      ->capture_default_str()
      ->type_name("S");
  command
      ->add_option("--known", arguments->known,
                   "A value that the device shows, to be searched for: 230.4, voltage=230.4, voltage=230.4±2")
      ->type_name("[NAME=]VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--out", arguments->out, "Write a draft of the map")->type_name("FILE");
  command->add_flag("--force", arguments->force, "Replace a file that is there");
  command->footer(
      "Example:\n  coupler probe 192.168.1.17 --known voltage=230.4 --known frequency=50.02 --out "
      "meter.yaml\n"
      "Ctrl-C ends it and shows what was found so far.");
  command->callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
