// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/probe_call.hpp"

#include <chrono>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::tools {
namespace {

using Units = std::vector<std::uint8_t>;

tl::unexpected<Failure> wrong(std::string what, std::string remedy) {
  return fail(bad_call, std::move(what), std::move(remedy));
}

/// Units that can be asked; 248 to 254 are reserved, and 0 is a broadcast with RTU.
bool is_unit(std::uint64_t unit, bool is_rtu) {
  return is_rtu_unit(unit) || (!is_rtu && (unit == 0 || unit == 255));
}

/// "5" or "1-247".
bool add_units(std::string_view text, bool is_rtu, Units& units) {
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

/// Those to ask. `is_given`: the address names connection.unit.
tl::expected<Units, Failure> units_of(const std::vector<std::string>& texts, const Connection& connection,
                                      bool is_given) {
  const bool is_rtu = connection.is_rtu();
  if (is_given && !texts.empty())
    return wrong(fmt::format("both --units and the address, which ends in /{}, say which units to ask",
                             connection.unit),
                 "leave one of them out");
  Units units;
  for (const std::string& text : texts)
    if (!add_units(text, is_rtu, units))
      return wrong(
          fmt::format("'{}' is not a unit id", text),
          is_rtu ? "give 1 to 247, as --units 1-10,17" : "give 0 to 247 or 255, as --units 1-10,255");
  if (!units.empty()) return units;
  if (is_given && !is_unit(connection.unit, is_rtu))
    return wrong(fmt::format("unit {} is reserved", connection.unit), "give 0 to 247 or 255");
  if (is_given) return Units{connection.unit};
  if (is_rtu) add_units("1-247", true, units);
  return is_rtu ? units : scan::Task{}.units;
}

tl::expected<std::vector<scan::KnownValue>, Failure> known_values(const std::vector<std::string>& texts) {
  std::vector<scan::KnownValue> known;
  for (const std::string& text : texts) {
    auto value = scan::parse_known_value(text);
    if (!value) return wrong("--known: " + value.error(), "see `coupler probe --help`");
    for (const scan::KnownValue& other : known)
      if (!other.name.empty() && other.name == value->name)
        return wrong(fmt::format("two values are named '{}'", other.name), "give each --known its own name");
    known.push_back(std::move(*value));
  }
  return known;
}

/// The settings of a serial port that are tried: what is given, otherwise what is usual, the most usual
/// first.
tl::expected<std::vector<Serial>, Failure> lines_of(const ProbeArguments& arguments, const Serial& line,
                                                    const std::string& address) {
  const auto gives = [&](std::string_view key) { return address.find(key) != std::string::npos; };
  std::vector<std::uint32_t> bauds;
  for (const std::string& text : arguments.bauds) {
    const auto baud = loader::parse_unsigned(text);
    if (!baud || *baud > 4'000'000 || !is_serial_rate(static_cast<std::uint32_t>(*baud)))
      return wrong(fmt::format("'{}' is no rate of serial ports", text), "give one as 9600, 19200 or 115200");
    bauds.push_back(static_cast<std::uint32_t>(*baud));
  }
  std::vector<Serial::Parity> parities;
  for (const std::string& text : arguments.parities) {
    const auto parity = parse_word<Serial::Parity>(text);
    if (!parity) return wrong(fmt::format("'{}' is no parity", text), "give even, odd or none");
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
std::chrono::milliseconds timeout_of(const ProbeArguments& arguments, bool is_serial) {
  const double seconds = arguments.timeout > 0 ? arguments.timeout : is_serial ? 0.1 : 1;
  return std::chrono::milliseconds(static_cast<long>(seconds * 1000));
}

}  // namespace

tl::expected<ProbeCall, Failure> understand(const ProbeArguments& arguments, const Place& place) {
  if (arguments.from > arguments.to)
    return wrong(fmt::format("--from {} is greater than --to {}", arguments.from, arguments.to), "swap them");
  ProbeCall call;
  call.connection = place.connection;
  const Serial& line = call.connection.serial;
  auto units = units_of(arguments.units, call.connection, names_a_unit(place.node, *place.text));
  if (!units) return tl::make_unexpected(units.error());
  auto known = known_values(arguments.known);
  if (!known) return tl::make_unexpected(known.error());
  call.connection.timeout = timeout_of(arguments, line.present());
  call.lines = {line};
  if (!line.present() && !(arguments.bauds.empty() && arguments.parities.empty()))
    return wrong("--baud and --parity are for a serial port",
                 "give its path, as /dev/ttyUSB0, or leave them out");
  if (line.present()) {
    auto lines = lines_of(arguments, line, *place.text);
    if (!lines) return tl::make_unexpected(lines.error());
    call.lines = std::move(*lines);
  }
  call.task.units = std::move(*units);
  call.task.stride = arguments.stride;
  call.task.rate = arguments.rate;
  if (!arguments.scan) call.task.ends = scan::Task::Ends::at_node;
  call.task.window = modbus::Range::of(arguments.from, arguments.to - arguments.from + 1);
  call.known = std::move(*known);
  return call;
}

}  // namespace coupler::tools
