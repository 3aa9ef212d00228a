// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/identity.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::formats {
namespace {

using codec::Type;

/// A basic string of TOML, quotes included.
std::string literal(std::string_view text) { return double_quoted(text, "\\u{:04X}", Escapes::characters); }

/// A float of TOML, even if it is whole.
std::string number(double value) {
  const std::string text = fmt::to_string(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string_view register_of(Table table) {
  switch (table) {
    case Table::coils: return "coil";
    case Table::discrete_inputs: return "discrete";
    case Table::input_registers: return "input";
    case Table::holding_registers: return "holding";
  }
  return {};
}

/// Telegraf has only ABCD and DCBA for values of one register, whatever their type.
std::string_view byte_order_of(const Point& point) {
  if (holds_bits(point.table)) return "ABCD";
  if (codec::width(point.format.type) <= 16)
    return codec::bytes_swapped(point.format.order) ? "DCBA" : "ABCD";
  return codec::to_string(point.format.order, false);
}

std::string type_of(const codec::Format& format) {
  const char half = format.half == codec::Half::high ? 'H' : 'L';
  switch (format.type) {
    case Type::BOOL: return "BIT";
    case Type::SINT: return fmt::format("INT8{}", half);
    case Type::BYTE:
    case Type::USINT:
    case Type::CHAR: return fmt::format("UINT8{}", half);
    case Type::INT: return "INT16";
    case Type::WORD:
    case Type::UINT: return "UINT16";
    case Type::DINT: return "INT32";
    case Type::DWORD:
    case Type::UDINT: return "UINT32";
    case Type::LINT: return "INT64";
    case Type::LWORD:
    case Type::ULINT: return "UINT64";
    case Type::REAL: return "FLOAT32";
    case Type::LREAL: return "FLOAT64";
    case Type::STRING: return "STRING";
  }
  return {};
}

std::string field_of(const Point& point, std::uint16_t element, const std::string& name) {
  const auto address = read_range(point).start() + element * codec::registers(point.format);
  std::string field = fmt::format("address = {}, name = {}", address, literal(name));
  if (!holds_bits(point.table)) {
    const codec::Format& format = point.format;
    field += fmt::format(", type = \"{}\"", type_of(format));
    if (format.type == Type::STRING) field += fmt::format(", length = {}", codec::registers(format));
    if (format.type == Type::BOOL && format.bit != 0) field += fmt::format(", bit = {}", format.bit);
    if (point.scale.gain != 1) field += fmt::format(", scale = {}", number(point.scale.gain));
  }
  return field;
}

/// "mm, the left door", or nothing.
std::string comment_of(const Point& point) {
  std::string text(point.units);
  if (!point.units.empty() && !point.description.empty()) text += ", ";
  text += point.description;
  return text.empty() ? text : "  # " + printable(text);
}

/// Telegraf refuses a field if the address after it is past 65535.
bool is_at_the_end(const Point& point) { return read_range(point).end() > 0xFFFF; }

void add_warnings(const Point& point, ConversionWarnings& warnings) {
  warn_of_raw_meaning(point, false, warnings);
  if (point.scale.offset != 0)
    warnings.add("the offset of a scale is left out", "add it with [[processors.scale]]", point.name);
  if (!point.units.empty() || !point.description.empty())
    warnings.add("units and descriptions are comments", "no action is needed", point.name);
  if (point.host.rate > 0)
    warnings.add("all points are read at the map's rate, not at rates of their own",
                 "put them into a second [[inputs.modbus]] with its own interval", point.name);
  if (is_writable(point))
    warnings.add("Telegraf only reads, so writing is left out", "no action is needed", point.name);
  if (point.format.type == Type::STRING && point.format.encoding != codec::Encoding::utf8)
    warnings.add("texts are read as UTF-8", "convert the field where it is shown", point.name);
  if (point.count > 1)
    warnings.add("arrays become several fields, whose names end in _0, _1, ...", "no action is needed",
                 point.name);
  if (!point.values.empty())
    warnings.add("names of values need Telegraf 1.35 or later",
                 "with an older one delete the sections [[processors.enum]]", point.name);
}

/// Returns whether the point can be a field, and warns if it cannot.
bool is_field(const Point& point, ConversionWarnings& warnings) {
  if (!is_readable(point))
    warnings.add("write-only points are left out", "no action is needed: Telegraf only reads", point.name);
  else if (point.format.bits != 0)
    warnings.add("numbers in some bits of a register are left out", "read the register and use a processor",
                 point.name);
  else if (is_at_the_end(point))
    warnings.add("Telegraf refuses fields that end at address 65535, so they are left out", "move the point",
                 point.name);
  else
    return true;
  return false;
}

using Requests =
    std::map<std::pair<Table, std::string_view>, std::string>;  // fields, by table and byte order

std::string request_of(const Map& map, Table table, std::string_view order, const std::string& fields) {
  std::string text = fmt::format(
      "\n  [[inputs.modbus.request]]\n    slave_id = {}\n    byte_order = \"{}\"\n    register = \"{}\"\n    "
      "measurement = {}\n",
      map.connection.unit, order, register_of(table), literal(map.name));
  const bool joins = holds_bits(table) ? map.polling.discrete_continuous : map.polling.register_continuous;
  const bool has_holes = std::any_of(map.unreadable.begin(), map.unreadable.end(),
                                     [table](const TableRange& area) { return area.table == table; });
  const unsigned gap = holds_bits(table) ? map.polling.discrete_gap : map.polling.register_gap;
  const unsigned most = holds_bits(table) ? modbus::max_read_bits : modbus::max_read_registers;
  if (joins && !has_holes && gap > 1)
    text += fmt::format("    optimization = \"max_insert\"\n    optimization_max_register_fill = {}\n",
                        std::min(gap - 1, most));
  return text + "    fields = [\n" + fields + "    ]\n";
}

std::string controller_of(const Map& map) {
  const Connection& connection = map.connection;
  const Serial& line = connection.serial;
  if (line.present())
    return fmt::format(
        "  controller = {}\n  transmission_mode = \"RTU\"\n  baud_rate = {}\n  data_bits = 8\n  parity = "
        "\"{}\"\n"
        "  stop_bits = {}\n",
        literal(fmt::format("file://{}", line.device)), line.baud, parity_letter(line.parity),
        line.stop_bits);
  const std::string_view address = connection.address.empty() ? "localhost" : connection.address;
  const bool is_ipv6 = address.find(':') != std::string_view::npos;
  return fmt::format(
      "  controller = {}\n{}",
      literal(fmt::format(is_ipv6 ? "tcp://[{}]:{}" : "tcp://{}:{}", address, port_without_tls(map))),
      connection.is_rtu() ? "  transmission_mode = \"RTUoverTCP\"\n" : "");
}

std::string connection_of(const Map& map) {
  const auto interval = std::max(1L, std::lround(1000 / map.polling.rate));
  std::string text = fmt::format(
      "[[inputs.modbus]]\n  name = {}\n{}  timeout = \"{}ms\"\n  interval = \"{}ms\"\n"
      "  configuration_type = \"request\"\n",
      literal(map.name), controller_of(map), map.connection.timeout.count(), interval);
  const Limits& limits = map.limits;
  if (limits.connect_delay.count() > 0 || limits.request_gap.count() > 0)
    text += fmt::format(
        "\n  [inputs.modbus.workarounds]\n    pause_after_connect = \"{}ms\"\n    pause_between_requests = "
        "\"{}ms\"\n",
        limits.connect_delay.count(), limits.request_gap.count());
  return text;
}

void add_warnings(const Map& map, ConversionWarnings& warnings) {
  if (!map.connection.present())
    warnings.add("the map does not have the device's address, so localhost is written",
                 "write the address after tcp://");
  const Limits usual;
  if (map.limits.read_registers < usual.read_registers || map.limits.read_bits < usual.read_bits)
    warnings.add("Telegraf limits the size of a read as Modbus does, not as the map does",
                 "use Telegraf's workaround one_request_per_field if the device refuses reads");
  warn_of_node_and_driver_keys(map, warnings);
  warn_of_rights(map, false, warnings);
}

/// The names of a field's values, in a second field: what is computed with stays a number.
std::string mapping_of(const std::string& field, const std::string& dest, const std::string& names) {
  return fmt::format(
      "\n  [[processors.enum.mapping]]\n    fields = [{}]\n    dest = {}\n"
      "    [processors.enum.mapping.value_mappings]\n{}",
      literal(field), literal(dest), names);
}

std::string names_of(const Point& point) {
  std::string names;
  for (const NamedValue& each : point.values)
    names += fmt::format("      \"{}\" = {}\n", each.value, literal(each.name));
  return names;
}

std::string processor_of(std::string_view measurement, const std::string& mappings) {
  if (mappings.empty()) return {};
  return fmt::format("\n[[processors.enum]]\n  namepass = [{}]\n", literal(measurement)) + mappings;
}

std::string statistics_field(std::uint16_t at, std::string_view name, std::string_view type) {
  return fmt::format("      {{ address = {}, name = \"{}\", type = \"{}\" }},\n",
                     identity::reserved.start() + at, name, type);
}

/// A request of its own for the part of the identity area that changes.
std::string statistics_request(const Map& map, const std::string& measurement) {
  std::vector<std::pair<std::uint16_t, std::string>> fields = {
      {identity::at_watchdog_state, statistics_field(identity::at_watchdog_state, "watchdog", "UINT16")},
      {identity::at_watchdog_left,
       statistics_field(identity::at_watchdog_left, "watchdog_left_ms", "UINT16")},
      {identity::at_uptime, statistics_field(identity::at_uptime, "uptime_s", "UINT32")}};
  for (const identity::Counter& counter : identity::counters)
    fields.emplace_back(counter.at, statistics_field(counter.at, counter.key, "UINT32"));
  std::sort(fields.begin(), fields.end());
  std::string text;
  for (const auto& [at, field] : fields) text += field;
  return fmt::format(
             "\n  [[inputs.modbus.request]]\n    slave_id = {}\n    byte_order = \"ABCD\"\n    register = "
             "\"input\"\n"
             "    measurement = {}\n    fields = [\n",
             map.connection.unit, literal(measurement)) +
         text + "    ]\n";
}

std::string watchdog_names() {
  std::string names;
  for (std::size_t i = 0; i < identity::watchdog_states.size(); ++i)
    names += fmt::format("      \"{}\" = \"{}\"\n", i, identity::watchdog_states[i]);
  return names;
}

/// A map with points there is not a node's.
bool has_identity_area(const Map& map) {
  return std::none_of(map.points.begin(), map.points.end(), [](const Point& point) {
    return point.table == Table::input_registers && range(point).end() > identity::reserved.start();
  });
}

Export write(const Map& map, bool statistics) {
  Export out;
  add_warnings(map, out.warnings);
  Requests requests;
  std::vector<const Point*> points;
  for (const Point& point : map.points)
    if (is_field(point, out.warnings)) points.push_back(&point);
  // Single points first: they have their own names, and elements of arrays give way.
  std::stable_partition(points.begin(), points.end(), [](const Point* point) { return point->count == 1; });
  UniqueNames names(out.warnings);
  std::vector<std::pair<std::string, const Point*>> named;
  for (const Point* point : points) {
    add_warnings(*point, out.warnings);
    std::string& fields = requests[{point->table, byte_order_of(*point)}];
    for (std::uint16_t element = 0; element < point->count; ++element) {
      const std::string field =
          names.make(point->count > 1 ? fmt::format("{}_{}", point->name, element) : std::string(point->name),
                     point->name);
      fields += fmt::format("      {{ {} }},{}\n", field_of(*point, element, field),
                            element == 0 ? comment_of(*point) : "");
      if (!point->values.empty()) named.emplace_back(field, point);
    }
  }
  std::string mappings;
  for (const auto& [field, point] : named)
    mappings += mapping_of(field, names.make(field + "_name", point->name), names_of(*point));
  out.text = "# Made by `coupler export --to telegraf`.\n" + connection_of(map);
  for (const auto& [key, fields] : requests) out.text += request_of(map, key.first, key.second, fields);
  const std::string measurement = fmt::format("{}_node", map.name);
  if (statistics && !has_identity_area(map)) {
    out.warnings.add("the map has points where a node has its statistics, so those are left out",
                     "leave --node-statistics out: the device is not a node");
    statistics = false;
  }
  if (statistics) out.text += statistics_request(map, measurement);
  out.text += processor_of(map.name, mappings);
  if (statistics)
    out.text += processor_of(measurement, mapping_of("watchdog", "watchdog_name", watchdog_names()));
  return out;
}

}  // namespace

Export write_telegraf(const Map& map) { return write(map, false); }

Export write_telegraf_with_statistics(const Map& map) { return write(map, true); }

}  // namespace coupler::formats
