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
#include "coupler/map/fields.hpp"
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
  double timeout = 0;  ///< s; 0: not given
  std::vector<std::string> bauds;
  std::vector<std::string> parities;
  std::vector<std::string> known;
  std::string out;
  bool force = false;
};

struct Call {
  Connection connection;
  std::vector<Serial> lines;  ///< to try until a unit answers; one without a device: it is reached by TCP
  Task task;
  std::vector<scan::KnownValue> known;
};

/// Why a call cannot be understood, and what to do.
struct WrongCall {
  std::string what;
  std::string remedy;
};

/// Units that can be asked; 248 to 254 are reserved, and 0 is a broadcast with RTU.
bool is_unit(std::uint64_t unit, bool is_rtu) {
  return is_rtu ? unit >= 1 && unit <= 247 : unit <= 247 || unit == 255;
}

/// "5" or "1-247".
bool add_units(std::string_view text, bool is_rtu, std::vector<std::uint8_t>& units) {
  const auto dash = text.find('-');
  const auto first = loader::parse_unsigned(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : loader::parse_unsigned(text.substr(dash + 1));
  if (!first || !last || *first > *last || !is_unit(*first, is_rtu) || !is_unit(*last, is_rtu)) return false;
  for (auto unit = *first; unit <= *last; ++unit)
    if (is_unit(unit, is_rtu)) units.push_back(static_cast<std::uint8_t>(unit));
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
  const bool is_rtu = where.serial.present() || where.framing == Framing::rtu;
  for (const std::string& text : arguments.units)
    if (!add_units(text, is_rtu, units))
      return tl::make_unexpected(WrongCall{
          fmt::format("'{}' is not a unit id", text),
          is_rtu ? "give 1 to 247, as --units 1-10,17" : "give 0 to 247 or 255, as --units 1-10,255"});
  if (!units.empty()) return units;
  if (has_unit && !is_unit(where.unit, is_rtu))
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

/// The settings of a serial port that are tried: what is given, otherwise what is usual, the most usual
/// first.
tl::expected<std::vector<Serial>, WrongCall> lines_of(const Arguments& arguments, const Serial& line,
                                                      const std::string& address) {
  const auto gives = [&](std::string_view key) { return address.find(key) != std::string::npos; };
  std::vector<std::uint32_t> bauds;
  for (const std::string& text : arguments.bauds) {
    const auto baud = loader::parse_unsigned(text);
    if (!baud || *baud > 4'000'000 || !is_serial_rate(static_cast<std::uint32_t>(*baud)))
      return tl::make_unexpected(WrongCall{fmt::format("'{}' is no rate of serial ports", text),
                                           "give one as 9600, 19200 or 115200"});
    bauds.push_back(static_cast<std::uint32_t>(*baud));
  }
  std::vector<Serial::Parity> parities;
  for (const std::string& text : arguments.parities) {
    const auto parity = parse_word<Serial::Parity>(text);
    if (!parity)
      return tl::make_unexpected(WrongCall{fmt::format("'{}' is no parity", text), "give even, odd or none"});
    parities.push_back(*parity);
  }
  if (bauds.empty() && gives("baud=")) bauds = {line.baud};
  if (bauds.empty()) bauds = {9600, 19200, 115200, 38400, 57600, 4800};
  if (parities.empty() && gives("parity=")) parities = {line.parity};
  if (parities.empty()) parities = {Serial::Parity::none, Serial::Parity::even};
  std::vector<Serial> lines;
  for (const std::uint32_t baud : bauds)
    for (const Serial::Parity parity : parities) {
      lines.push_back(line);
      lines.back().baud = baud;
      lines.back().parity = parity;
    }
  return lines;
}

/// A unit on a serial line answers within some milliseconds, and there are many to be asked.
std::chrono::milliseconds timeout_of(const Arguments& arguments, bool is_serial) {
  const double seconds = arguments.timeout > 0 ? arguments.timeout : is_serial ? 0.1 : 1;
  return std::chrono::milliseconds(static_cast<long>(seconds * 1000));
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
  const Serial& line = call.connection.serial;
  call.connection.timeout = timeout_of(arguments, line.present());
  call.lines = {line};
  if (!line.present() && !(arguments.bauds.empty() && arguments.parities.empty()))
    return tl::make_unexpected(WrongCall{"--baud and --parity are for a serial port",
                                         "give its path, as /dev/ttyUSB0, or leave them out"});
  if (line.present()) {
    auto lines = lines_of(arguments, line, address);
    if (!lines) return tl::make_unexpected(lines.error());
    call.lines = std::move(*lines);
  }
  if (units->empty() && call.connection.is_rtu()) add_units("1-247", true, *units);
  if (!units->empty()) call.task.units = std::move(*units);
  call.task.stride = arguments.stride;
  call.task.rate = arguments.rate;
  call.task.window = modbus::Range::of(arguments.from, arguments.to - arguments.from + 1);
  call.known = std::move(*known);
  return call;
}

scan::Findings look(const Call& call, ProgressBar& progress) {
  ModbusClient client(call.connection);
  host::SteadyClock clock;
  const Interruption interruption([&] {
    progress.end();
    clock.stop();
    client.interrupt();
  });
  return scan::scan(call.task, client, clock, progress);
}

/// With the settings of the line at which a unit has answered.
scan::Findings look_at_each_line(Call& call) {
  ProgressBar progress;
  scan::Findings findings;
  bool is_asked = false;
  for (std::size_t i = 0; i < call.lines.size(); ++i) {
    const Serial& line = call.lines[i];
    call.connection.serial = line;
    if (line.present())
      progress.where(
          fmt::format("at {}{}", rate_and_parity(line),
                      call.lines.size() > 1 ? fmt::format(" ({} of {})", i + 1, call.lines.size()) : ""));
    scan::Findings found = look(call, progress);
    const bool is_refused = found.broke_off && found.requests == 0;  // perhaps not the next one
    if (!is_refused || !is_asked) findings = std::move(found);
    is_asked |= !is_refused;
    if (findings.unit || (findings.broke_off && !is_refused) || progress.wants_end()) break;
  }
  return findings;
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

  const scan::Findings findings = look_at_each_line(*call);
  if (findings.broke_off)
    complain("probe", failed, host::to_string(*findings.broke_off),
             reach_remedy(
                 call->connection, std::holds_alternative<host::Timeout>(*findings.broke_off),
                 "check that the device is on, that the port is right, and that no other client holds its "
                 "last connection"));
  if (!findings.unit && findings.is_complete && call->connection.is_rtu())
    return complain("probe", failed,
                    fmt::format("none of {} units answers on this line", call->task.units.size()),
                    call->connection.serial.present() ? "check A and B, the power, and the module's rate and "
                                                        "parity: --baud and --parity say what is tried"
                                                      : "check A and B, the power, and the gateway's rate "
                                                        "and parity; if it translates, give its address "
                                                        "without rtu+");
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
  command.add_option("HOST", arguments->host, "HOST[:PORT][/UNIT], or a serial port as /dev/ttyUSB0[/UNIT]")
      .required()
      .type_name("");
  command
      .add_option("--units", arguments->units,
                  "Unit ids to ask, as 1-247 (default: 1, 255, 0; with RTU 1-247)")
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
  command
      .add_option("--timeout", arguments->timeout,
                  "Longest wait for an answer, in seconds; default 1, on a serial line 0.1")
      .in_range(0.01, 60.0)
      .type_name("S");
  command
      .add_option("--baud", arguments->bauds,
                  "On a serial line: rates to try (default: 9600,19200,115200,38400,57600,4800)")
      .delimiter(',')
      .type_name("N");
  command
      .add_option("--parity", arguments->parities, "On a serial line: parities to try (default: none,even)")
      .delimiter(',')
      .type_name("WORD");
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
      "meter.yaml\n  coupler probe /dev/ttyUSB0 --baud 9600\n"
      "Ctrl-C ends it and shows what was found so far.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
