// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "coupler/map/escape.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::formats {
namespace {

constexpr Exporter formats[] = {
    {"csv", "a table of points, for spreadsheets and for `coupler import csv`", write_csv, false},
    {"home-assistant", "the modbus integration's part of configuration.yaml", write_home_assistant, true},
    {"st", "types, variables and function blocks in Structured Text, for a PLC that reads the device",
     write_structured_text, true},
    {"telegraf", "a section [[inputs.modbus]] of telegraf.conf", write_telegraf, true,
     write_telegraf_with_statistics},
    {"wireshark", "a dissector (Lua) that names the points in captures", write_wireshark, false},
};

std::string list_of(const std::vector<std::string>& points) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(points.size(), most); ++i)
    text += fmt::format("{}{}", i == 0 ? ": " : ", ", points[i]);
  if (points.size() > most) text += fmt::format(" and {} more", points.size() - most);
  return text;
}

bool is_of_the_node(const Point& point) {
  return point.line.present() || is_analogue(point) || point.counter.present() || point.latched.present() ||
         !point.initial.empty() || point.safe != Safe::off || is_pulsed(point);
}

/// The rate is not, and a deadband and a queue for subscribers have no meaning by themselves.
bool is_of_the_driver(const Point& point) {
  HostOptions host = point.host;
  host.rate = 0;
  host.deadband = 0;
  host.queue_size = HostOptions{}.queue_size;
  return !has_defaults(host) || host.deadman.present();
}

}  // namespace

void ConversionWarnings::add(std::string_view what, std::string_view remedy, std::string_view point,
                             loader::Position at) {
  auto found = std::find_if(warnings_.begin(), warnings_.end(),
                            [what](const ConversionWarning& warning) { return warning.what == what; });
  if (found == warnings_.end())
    found = warnings_.insert(found, {std::string(what), std::string(remedy), {}, at});
  if (point.empty() || (!found->points.empty() && found->points.back() == point)) return;
  found->points.emplace_back(point);
}

Diagnostics ConversionWarnings::diagnostics(std::string_view file) const {
  Diagnostics out;
  for (const ConversionWarning& warning : warnings_) {
    Diagnostic diagnostic;
    diagnostic.severity = Diagnostic::Severity::warning;
    diagnostic.file = file;
    diagnostic.line = warning.at.line;
    diagnostic.column = warning.at.column;
    diagnostic.what = warning.what + list_of(warning.points);
    diagnostic.remedy = warning.remedy;
    out.push_back(std::move(diagnostic));
  }
  return out;
}

Span<const Exporter> exporters() { return formats; }

const Exporter* find_exporter(std::string_view name) {
  const auto* found = std::find_if(std::begin(formats), std::end(formats),
                                   [name](const Exporter& exporter) { return exporter.name == name; });
  return found == std::end(formats) ? nullptr : found;
}

bool lets_read_without_tls(const Map& map) {
  if (!map.security.present()) return true;
  const Role* role = map.security.plain_role();
  for (std::size_t i = 0; role != nullptr && i < map.points.size(); ++i)
    if (role->may(Right::read, i)) return true;
  return false;
}

void warn_of_rights(const Map& map, bool writes, ConversionWarnings& warnings) {
  const Role* role = map.security.plain_role();
  if (role == nullptr) return;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    if (is_readable(point) && !role->may(Right::read, i))
      warnings.add("clients without TLS may not read these points, and the device will refuse it",
                   "give the role of 'plain' the right to read them", point.name);
    if (writes && is_writable(point) && !role->may(Right::write, i))
      warnings.add("clients without TLS may not write these points, and the device will refuse it",
                   "give the role of 'plain' the right to write them, if the program has to", point.name);
  }
}

void warn_of_node_and_driver_keys(const Map& map, ConversionWarnings& warnings) {
  if (map.connection.tls.present())
    warnings.add(
        "the map has TLS, and this format has not",
        map.service.port == map.connection.port
            ? "name the coupler's port without TLS, where a node lets in whom its 'plain' says"
            : fmt::format("port {}, without TLS, is written; a node lets in there whom its 'plain' says",
                          map.service.port));
  if (!map.limits.transaction_ids)
    warnings.add("the device does not repeat transaction ids, and other programs compare them",
                 "look for a gateway that repeats them, or an option of the other program");
  if (!map.read_whole.empty())
    warnings.add("other programs do not know which areas a device gives in one piece only ('read_whole')",
                 "let them read each area in one request, as far as they can");
  for (const Point& point : map.points) {
    if (is_of_the_node(point))
      warnings.add(
          "lines, channels, counters, initial and safe values and pulses belong to the node and are left out",
          "no action is needed: the node has the map", point.name);
    if (is_of_the_driver(point))
      warnings.add("the driver's options of points are left out",
                   "look for similar options in the other program", point.name);
  }
}

void warn_of_tools(const Map& map, ConversionWarnings& warnings) {
  for (const Tool& tool : map.tools)
    if (!tool.close.empty() && !tool.open.empty())
      warnings.add("nothing there keeps 'close' and 'open' of a tool from being on together",
                   "switch one off before the other goes on", tool.name);
}

void warn_of_raw_meaning(const Point& point, bool writes_invalid, ConversionWarnings& warnings) {
  if (!point.invalid.empty() && !writes_invalid)
    warnings.add("raw values that mean 'no value' are left out, so they look like values",
                 "compare the value with them in the other program", point.name);
  if (point.faults.present())
    warnings.add("'fault_below' and 'fault_above' are left out, so faults look like values",
                 "compare the raw value with them in the other program", point.name);
  if (point.scale.has_exponent())
    warnings.add("the exponent of a scale is in a register, so it is left out",
                 "multiply the value by 10 to the power of that point in the other program", point.name);
}

std::string UniqueNames::make(const std::string& name, std::string_view point) {
  std::string unique = name;
  for (int n = 2; !taken_.insert(unique).second; ++n) unique = fmt::format("{}_{}", name, n);
  if (unique != name)
    warnings_.add("names that would be those of other points get a number", "rename one of the points",
                  point);
  return unique;
}

std::string double_quoted(std::string_view text, std::string_view control, Escapes escapes) {
  return coupler::double_quoted(text, [&](const Character& c, std::string_view bytes) {
    const auto escaped = [control](unsigned number) { return fmt::format(fmt::runtime(control), number); };
    std::string out;
    if (!turns_direction(c.code) && c.code >= 0x20 && c.code != 0x7F) return out;
    if (escapes == Escapes::characters) return escaped(static_cast<unsigned>(c.code));
    for (const char byte : bytes) out += escaped(static_cast<unsigned char>(byte));
    return out;
  });
}

}  // namespace coupler::formats
