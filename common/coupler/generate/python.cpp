// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/python.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/generate/code.hpp"
#include "coupler/generate/member.hpp"
#include "coupler/map/functions.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/map/typed_value.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::generate {
namespace {

using codec::Type;

// Words of Python; and what a client has, or a member of an IntEnum, which is an int.
constexpr std::string_view taken_by_client[] = {
    "changes",    "False", "None",   "True",   "address", "and",         "as",       "assert",
    "async",      "await", "break",  "class",  "connect", "continue",    "def",      "del",
    "disconnect", "elif",  "else",   "except", "finally", "fingerprint", "for",      "from",
    "global",     "if",    "import", "in",     "is",      "lambda",      "nonlocal", "not",
    "online",     "or",    "pass",   "points", "port",    "raise",       "read_all", "return",
    "timeout",    "try",   "unit",   "verify", "while",   "with",        "yield"};
constexpr std::string_view taken_by_int[] = {
    "False",      "None",       "True",     "and",       "as",         "as_integer_ratio",
    "assert",     "async",      "await",    "bit_count", "bit_length", "break",
    "class",      "conjugate",  "continue", "def",       "del",        "denominator",
    "elif",       "else",       "except",   "finally",   "for",        "from",
    "from_bytes", "global",     "if",       "imag",      "import",     "in",
    "is",         "is_integer", "lambda",   "mro",       "name",       "nonlocal",
    "not",        "numerator",  "or",       "pass",      "raise",      "real",
    "return",     "to_bytes",   "try",      "value",     "while",      "with",
    "yield"};

std::vector<std::string_view> taken_by(const Connection& connection) {
  std::vector<std::string_view> names(std::begin(taken_by_client), std::end(taken_by_client));
  if (connection.serial.present())
    for (const std::string_view name : {"baud", "device", "parity", "rs485", "stop_bits"})
      names.push_back(name);
  return names;
}

/// `member`: the name of the point in Python. A device may have values that the map gives no name.
std::string python_type(const Point& point, std::string_view member) {
  std::string one = point.values.empty() ? "int" : fmt::format("values.{} | int", member);
  switch (point.format.type) {
    case Type::BOOL: one = "bool"; break;
    case Type::STRING: one = "str"; break;
    case Type::REAL:
    case Type::LREAL: one = "float"; break;
    default:
      if (point.scale.present()) one = "float";
  }
  return point.count == 1 ? one : fmt::format("list[{}]", one);
}

/// The function code that writes the point, which is alone in its request.
int function_code(const Point& point, const Limits& limits) {
  const bool masked = is_partial(point) && limits.mask_write;
  return static_cast<int>(masked
                              ? modbus::Function::mask_write_register
                              : write_function(point.table, range(point).count(), point.host.write_function));
}

/// The number that the point's registers hold for a bound of the map.
std::string bound(const Point& point, double number) {
  return codec::decimal(codec::nearest_published(number, point.format, point.scale));
}

/// Returns the values of a register point as arguments of Spec.
std::string format_arguments(const Point& point) {
  const codec::Format& format = point.format;
  std::string out;
  if (codec::registers(format) > 1) out += fmt::format(", size={}", codec::registers(format));
  if (point.count > 1) out += fmt::format(", count={}", point.count);
  if (codec::order_text(format) != "AB") out += fmt::format(", order=\"{}\"", codec::order_text(format));
  if (is_partial(point)) out += fmt::format(", mask=0x{:04X}", codec::mask(format));
  if (format.type == Type::STRING)
    out += fmt::format(", length={}, encoding=\"{}\"", format.length,
                       format.encoding == codec::Encoding::utf8 ? "utf-8" : to_string(format.encoding));
  if (point.scale.present())
    out += fmt::format(", gain={}, offset={}", codec::decimal(point.scale.gain),
                       codec::decimal(point.scale.offset));
  if (point.scale.has_exponent()) out += ", exponent_of=" + python_literal(point.scale.exponent_of);
  if (point.faults.below != Faults::no_below) out += ", fault_below=" + codec::decimal(point.faults.below);
  if (point.faults.above != Faults::no_above) out += ", fault_above=" + codec::decimal(point.faults.above);
  if (!point.invalid.empty()) {
    out += ", invalid=(";
    for (const auto& [first, last] : point.invalid) out += fmt::format("(0x{:X}, 0x{:X}), ", first, last);
    out += ')';
  }
  return out;
}

/// Returns the values that may be written.
std::string allowed_arguments(const Point& point, std::string_view member) {
  std::string out;
  const auto [min, max, nonfinite] = point.bounds;
  if (!point.units.empty()) out += ", units=" + python_literal(point.units);
  if (min != Bounds::no_min) out += ", least=" + bound(point, min);
  if (max != Bounds::no_max) out += ", most=" + bound(point, max);
  if (nonfinite) out += ", nonfinite=True";
  if (forbids_values(point)) out += ", allowed=" + python_literal(allowed_text(point));
  if (!point.values.empty()) out += fmt::format(", names=values.{}", member);
  return out;
}

std::string spec(const Map& map, const Point& point, std::string_view member) {
  std::string out = fmt::format("{}, \"{}\", {}, \"{}\"", python_literal(point.name), to_string(point.table),
                                point.address, to_string(point.format.type));
  if (!holds_bits(point.table))
    out += format_arguments(point);
  else if (point.count > 1)
    out += fmt::format(", count={}", point.count);
  if (is_writable(point)) out += fmt::format(", write_with={}", function_code(point, map.limits));
  if (point.read_address) out += fmt::format(", read_address={}", *point.read_address);
  if (const modbus::Range whole = plan::read_extent(map, point); whole != read_range(point))
    out += fmt::format(", whole=({}, {})", whole.start(), whole.count());
  if (point.host.verify_write) out += ", verify_write=True";
  return out + allowed_arguments(point, member);
}

/// The requests that read every point, whatever the rates: nobody polls.
std::string requests(const Map& map) {
  std::vector<Point> points(map.points.begin(), map.points.end());
  for (Point& point : points) point.host.rate = 0;
  Map at_one_rate = map;
  at_one_rate.points = points;
  std::string out;
  for (const plan::GroupPlan& group : plan::make_read_plan(at_one_rate))
    for (const plan::ReadSpan& span : group.spans) {
      out += fmt::format("        (\"{}\", {}, {}, (", to_string(span.table), span.range.start(),
                         span.range.count());
      for (const std::uint32_t point : span.points) out += python_literal(map.points[point].name) + ", ";
      out.replace(out.size() - (span.points.size() > 1 ? 2 : 1), std::string::npos, ")),\n");
    }
  return out;
}

std::string value_classes(const Map& map, const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Point& point = map.points[i];
    if (point.values.empty()) continue;
    out += fmt::format("\n    class {}(_IntEnum):\n", names[i]);
    const auto members = identifiers(names_of(point), taken_by_int, is_name);
    for (std::size_t k = 0; k < members.size(); ++k)
      out += fmt::format("        {} = {}\n", members[k], point.values[k].value);
  }
  if (out.empty()) return out;
  return "\n\nclass values:\n    \"\"\"What the map calls the values of its points.\"\"\"\n" + out;
}

/// Keys of the map that need the driver or the client in C++.
std::string keys_left_out(const Map& map) {
  std::string out;
  const auto add = [&](bool has, std::string_view key) {
    if (has) out.append(out.empty() ? "" : ", ").append(key);
  };
  bool deadman = false;
  for (const Point& point : map.points) deadman |= point.host.deadman.present();
  add(deadman, "deadman");
  add(map.on_reconnect == OnReconnect::restore, "on_reconnect");
  add(map.on_shutdown == OnShutdown::safe, "on_shutdown");
  add(map.coupler_watchdog.present(), "watchdog (of the coupler)");
  add(!map.limits.transaction_ids, "transaction_ids (pymodbus compares them)");
  if (out.empty()) return out;
  return "    # The map has keys that this client does not carry out: " + out + ".\n";
}

/// Members of the class that differ from those of its base.
std::string flags(const Map& map) {
  std::string out;
  if (map.connection.serial.rs485) out += "    rs485 = True\n";
  if (!map.changes) out += "    _may_tell_changes = False\n";
  return out;
}

constexpr auto class_form = R"(

class {class_name}({base}):
    """The coupler of the map {map}."""

{left_out}{flags}    fingerprint = 0x{fingerprint:016x}
    _plan = (
{requests}    )
    _request_gap = {request_gap}
    _connect_delay = {connect_delay}

    def __init__(self, {place}, unit: int = {unit}, timeout: float = {timeout},
                 verify: Verify | str = Verify.{verify}{tls}) -> None:
        super().__init__({place_names}, unit, timeout, verify{tls_name})
{points})";

/// The parameters of the constructor that say where the coupler is.
std::string place_arguments(const Connection& connection) {
  const auto given = [](std::string_view place) {
    return place.empty() ? std::string() : " = " + python_literal(place);
  };
  const Serial& line = connection.serial;
  if (!line.present())
    return fmt::format("address: str{}, port: int = {}, *", given(connection.address), connection.port);
  return fmt::format("device: str{}, *, baud: int = {}, parity: str = \"{}\", stop_bits: int = {}",
                     given(line.device), line.baud, to_string(line.parity), line.stop_bits);
}

/// The parameter of the constructor for TLS, with what the map says of it.
std::string tls_parameter(const Tls& tls) {
  if (!tls.present()) return ", tls: Tls | ssl.SSLContext | None = None";
  std::string out = fmt::format(",\n                 tls: Tls | ssl.SSLContext | None = Tls({}, {}",
                                python_literal(tls.certificate), python_literal(tls.key));
  const std::pair<std::string_view, std::string_view> others[] = {
      {"ca", tls.ca}, {"name", tls.name}, {"pin", tls.pin}};
  for (const auto& [key, value] : others)
    if (!value.empty()) out += fmt::format(", {}={}", key, python_literal(value));
  return out + ")";
}

std::string_view base_class(const Connection& connection) {
  if (connection.serial.present()) return "SerialClient";
  return connection.is_rtu() ? "RtuClient" : "Client";
}

/// Silence between frames counts, too; not every release of pymodbus keeps it.
std::chrono::duration<double> pause_after_reply(const Map& map) {
  const std::chrono::duration<double> gap = map.limits.request_gap;
  const Serial& line = map.connection.serial;
  return line.present() ? std::max<std::chrono::duration<double>>(gap, silence_between_frames(line)) : gap;
}

std::string capitals(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string seconds(std::chrono::duration<double> duration) { return codec::decimal(duration.count()); }

}  // namespace

std::string python_class(std::string_view name) {
  std::string out;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') out += begins && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    begins = c == '_';
  }
  return out + "Client";
}

std::string python_client(const Map& map, const Provenance& provenance) {
  const auto names = identifiers(names_of(map), taken_by(map.connection), is_name);
  std::string points;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Point& point = map.points[i];
    const std::string_view kind = point_class(point.access);
    points += fmt::format("        #: {}\n        self.{}: {}[{}] = {}(self, Spec(\n            {}))\n",
                          printable(documentation(point)), names[i], kind, python_type(point, names[i]), kind,
                          spec(map, point, names[i]));
  }
  const Connection& connection = map.connection;
  const bool may_use_tls = !connection.is_rtu();
  return fmt::format(
             // In the first two lines, Python takes "coding=…" of a comment for the encoding: the first one
             // that it finds. With some encodings a description would be code.
             "# -*- coding: utf-8 -*-\n"
             "# Generated by coupler {}: do not edit, change the map.\n"
             "# {} as a client in Python, fingerprint {:016x}.\n",
             provenance.version, printable(provenance.source), map.fingerprint)
      .append(python_body())
      .append(connection.is_rtu() ? python_rtu_body() : "")
      .append(value_classes(map, names))
      .append(fmt::format(
          class_form, fmt::arg("class_name", python_class(provenance.name)), fmt::arg("map", map.name),
          fmt::arg("left_out", keys_left_out(map)), fmt::arg("fingerprint", map.fingerprint),
          fmt::arg("requests", requests(map)), fmt::arg("base", base_class(connection)),
          fmt::arg("flags", flags(map)), fmt::arg("request_gap", seconds(pause_after_reply(map))),
          fmt::arg("connect_delay", seconds(map.limits.connect_delay)),
          fmt::arg("place", place_arguments(connection)),
          fmt::arg("place_names",
                   connection.serial.present() ? "device, baud, parity, stop_bits" : "address, port"),
          fmt::arg("tls", may_use_tls ? tls_parameter(connection.tls) : std::string()),
          fmt::arg("tls_name", may_use_tls ? ", tls" : ""),
          fmt::arg("verify", capitals(to_string(map.verify))), fmt::arg("unit", connection.unit),
          fmt::arg("timeout", seconds(connection.timeout)), fmt::arg("points", points)));
}

}  // namespace coupler::generate
