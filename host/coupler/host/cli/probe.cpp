// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/output_argument.hpp"
#include "coupler/cli/report.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/modbus_client.hpp"
#include "coupler/host/cli/probe_report.hpp"
#include "coupler/host/cli/progress_bar.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

namespace fs = std::filesystem;
using scan::Task;

struct Arguments {
  std::string host;
  std::vector<std::string> units;
  std::uint32_t from = Task{}.window.start();
  std::uint32_t to = Task{}.window.last();
  std::uint32_t stride = Task{}.stride;
  double rate = Task{}.rate;
  double timeout = 1;  ///< s
  std::vector<std::string> known;
  std::string out;
  bool force = false;
};

struct Call {
  Connection connection;
  Task task;
  std::vector<scan::KnownValue> known;
};

/// Why a call cannot be understood, and what to do.
struct WrongCall {
  std::string what;
  std::string remedy;
};

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

bool names_a_unit(const NodeAddress& where, std::string_view address) {
  const auto* const end = where.serial.present() ? where.serial.device.end() : where.host.end();
  const std::string_view rest = address.substr(static_cast<std::size_t>(end - address.begin()));
  const auto slash = rest.find('/');
  return slash != std::string_view::npos && slash + 1 < rest.size();
}

/// Empty: those that are asked by default.
tl::expected<std::vector<std::uint8_t>, WrongCall> units_of(const Arguments& arguments,
                                                            const NodeAddress& where, bool has_unit) {
  std::vector<std::uint8_t> units;
  for (const std::string& text : arguments.units)
    if (!add_units(text, units))
      return tl::make_unexpected(
          WrongCall{fmt::format("'{}' is not a unit id", text), "give 0 to 247 or 255, as --units 1-10,255"});
  if (!units.empty()) return units;
  if (has_unit && !is_unit(where.unit))
    return tl::make_unexpected(
        WrongCall{fmt::format("unit {} is reserved", where.unit), "give 0 to 247 or 255"});
  if (has_unit) units.push_back(where.unit);
  return units;
}

tl::expected<std::vector<scan::KnownValue>, WrongCall> known_values(const std::vector<std::string>& texts) {
  std::vector<scan::KnownValue> known;
  for (const std::string& text : texts) {
    auto value = scan::parse_known_value(text);
    if (!value)
      return tl::make_unexpected(WrongCall{"--known: " + value.error(), "see `coupler probe --help`"});
    for (const scan::KnownValue& other : known)
      if (!other.name.empty() && other.name == value->name)
        return tl::make_unexpected(WrongCall{fmt::format("two values are named '{}'", other.name),
                                             "give each --known its own name"});
    known.push_back(std::move(*value));
  }
  return known;
}

/// What the command line means. The connection is a view of `address`.
tl::expected<Call, WrongCall> understand(const Arguments& arguments, const std::string& address) {
  const auto where = parse_node_address(address);
  if (!where) return tl::make_unexpected(WrongCall{where.error().what, where.error().remedy});
  if (arguments.from > arguments.to)
    return tl::make_unexpected(WrongCall{
        fmt::format("--from {} is greater than --to {}", arguments.from, arguments.to), "swap them"});
  auto units = units_of(arguments, *where, names_a_unit(*where, address));
  if (!units) return tl::make_unexpected(units.error());
  auto known = known_values(arguments.known);
  if (!known) return tl::make_unexpected(known.error());
  Call call;
  call.connection = found_at({}, *where).connection;
  call.connection.timeout = std::chrono::milliseconds(static_cast<long>(arguments.timeout * 1000));
  if (units->empty() && call.connection.is_rtu()) add_units("1-247", *units);
  if (!units->empty()) call.task.units = std::move(*units);
  call.task.stride = arguments.stride;
  call.task.rate = arguments.rate;
  call.task.window = modbus::Range::of(arguments.from, arguments.to - arguments.from + 1);
  call.known = std::move(*known);
  return call;
}

scan::Findings look(const Call& call) {
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
tl::expected<void, WrongCall> can_write(const Arguments& arguments) {
  if (names_no_file(arguments.out)) return {};
  const fs::path path(arguments.out);
  std::error_code ignored;
  if (!arguments.force && fs::exists(path, ignored))
    return tl::make_unexpected(WrongCall{arguments.out + " already exists",
                                         "name another file with --out, or replace it with --force"});
  if (path.has_parent_path() && !fs::is_directory(path.parent_path(), ignored))
    return tl::make_unexpected(WrongCall{path.parent_path().string() + " is not a folder",
                                         "create it, or name another one with --out"});
  return {};
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
    std::fputs(text.c_str(), stdout);
    return complain("probe", bad_call, outcome.error(), "the draft is on standard output instead");
  }
  if (!loaded.map) return bad_input;
  fmt::print("{}\nNext: give its points names and types, then `coupler plan {}`\n",
             summary(path, loaded.map->map()), path);
  return ok;
}

Exit run(const Arguments& arguments) {
  const std::string address = node_argument(arguments.host);
  auto call = understand(arguments, address);
  if (!call) return complain("probe", bad_call, call.error().what, call.error().remedy);
  if (const auto can = can_write(arguments); !can)
    return complain("probe", bad_call, can.error().what, can.error().remedy);

  const scan::Findings findings = look(*call);
  if (findings.broke_off)
    complain("probe", failed, host::to_string(*findings.broke_off),
             "check that the device is on, that the port is right, and that no other client holds its last "
             "connection");
  if (!findings.unit && findings.is_complete)
    return complain(
        "probe", failed,
        fmt::format("a server accepts connections, but none of {} units answers", call->task.units.size()),
        "give its unit id, as HOST/17, or try all with --units 0-247,255");
  if (!findings.unit) return failed;

  std::vector<scan::Match> matches;
  for (const scan::KnownValue& known : call->known)
    matches.push_back({known, scan::find_candidates(known, findings.tables)});
  call->connection.unit = *findings.unit;
  const bool to_file = arguments.out != standard_output;
  std::fputs(probe_report(findings, call->task, call->connection, matches).c_str(),
             to_file ? stdout : stderr);
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
    const Exit written = write(arguments.out, scan::draft_map(findings, call->connection, matches));
    if (written != ok) exit = written;
  }
  return exit;
}

}  // namespace

void add_probe(Program& program, Exit& exit) {
  auto command = program.add_command(
      "probe",
      "Find out what a device without a map answers to, and draft its map. It reads and never writes.");
  const auto arguments = std::make_shared<Arguments>();
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
                  "Where blocks are refused, try one address in N; 1 tries all")
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
                  "A value that the device displays, to search for: 230.4, voltage=230.4, voltage=230.4±2")
      .type_name("[NAME=]VALUE")
      .one_value();
  command
      .add_option("--out", arguments->out,
                  "Write a draft of the map; - is standard output, and the report is on standard error then")
      .type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace an existing file");
  command.footer(
      "Example:\n  coupler probe 192.168.1.17 --known voltage=230.4 --known frequency=50.02 --out "
      "meter.yaml\n"
      "Ctrl-C ends it and shows what was found so far.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
