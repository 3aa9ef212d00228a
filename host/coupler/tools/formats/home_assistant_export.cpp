// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/home_assistant_sensor.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using codec::Type;

constexpr int shortest_interval = 5;  // seconds; below it Home Assistant warns

std::string text(std::string_view value) { return flow(scalar("", std::string(value), {}, true)); }

/// "cell_north_speed"
std::string unique_id(const Map& map, const std::string& name) {
  std::string id = lower(fmt::format("{}_{}", map.name, name));
  std::replace_if(
      id.begin(), id.end(), [](char c) { return !loader::is_letter(c) && !loader::is_digit(c); }, '_');
  return id;
}

int interval_of(const Map& map, const Point& point) {
  const double rate = point.host.rate > 0 ? point.host.rate : map.polling.rate;
  return std::max(shortest_interval, static_cast<int>(std::ceil(1 / rate)));
}

/// Returns the type that the file has for a type that Home Assistant only has as a number.
std::string_view read_back_as(Type type) {
  switch (type) {
    case Type::WORD: return "UINT";
    case Type::DWORD: return "UDINT";
    case Type::LWORD: return "ULINT";
    case Type::BYTE:
    case Type::CHAR: return "USINT";
    default: return "";
  }
}

/// Lists of entities, by what Home Assistant calls them.
struct Entities {
  std::string binary_sensors;
  std::string switches;
  std::string sensors;
  std::string templates;  ///< of `template:`, since `modbus:` has no names of values
};

/// The id that Home Assistant gives a sensor of that name, unless another one has it: then it adds _2, _3 …
std::string entity_id(const std::string& name) {
  std::string id;
  for (const char c : lower(name)) {
    if (loader::is_letter(c) || loader::is_digit(c))
      id += c;
    else if (!id.empty() && id.back() != '_')
      id += '_';
  }
  while (!id.empty() && id.back() == '_') id.pop_back();
  return "sensor." + id;
}

/// The sensor's number as its name; a number without one stays.
std::string state_template(const Point& point, const std::string& sensor) {
  std::string names;
  for (const NamedValue& each : point.values)
    names += fmt::format("{}'{}': '{}'", names.empty() ? "" : ", ", each.value, each.name);
  return fmt::format("{{{{ {{{}}}.get(states('{}'), states('{}')) }}}}", names, sensor, sensor);
}

class EntityWriter {
 public:
  EntityWriter(const Map& map, ConversionWarnings& warnings)
      : map_(map), warnings_(warnings), ids_(warnings), sensor_ids_(warnings) {}

  Entities write() {
    for (const Point& point : map_.points) {
      if (point.format.bits != 0) {
        warnings_.add("numbers in some bits of a register are left out",
                      "make template sensors of the whole register", point.name);
        continue;
      }
      if (point.count > 1)
        warnings_.add("arrays become several entities, whose names end in 0, 1, ...", "no action is needed",
                      point.name);
      for (std::uint16_t element = 0; element < point.count; ++element) add(point, element);
      add_warnings(point);
    }
    // Nothing asks for these by id, so the sensors have the first choice.
    for (const auto& [id, point] : template_ids_) sensor_ids_.make(id, point);
    return std::move(entities_);
  }

 private:
  static constexpr std::string_view indent = "        ";

  static std::string name_of(const Point& point, std::uint16_t element) {
    return point.count > 1 ? fmt::format("{} {}", point.name, element) : std::string(point.name);
  }
  /// Returns the name that Home Assistant shows, and makes the entity's id of. Devices have points of the
  /// same name.
  std::string shown(const std::string& name) const { return fmt::format("{} {}", map_.name, name); }

  std::string head(const Point& point, std::uint16_t element, modbus::Range place) {
    const std::string name = name_of(point, element);
    const unsigned address = place.start() + static_cast<unsigned>(element) * codec::registers(point.format);
    return fmt::format("      - name: {}\n{}unique_id: {}\n{}slave: {}\n{}address: {}\n{}scan_interval: {}\n",
                       text(shown(name)), indent, ids_.make(unique_id(map_, name), point.name), indent,
                       map_.connection.unit, indent, address, indent, interval_of(map_, point));
  }

  void add(const Point& point, std::uint16_t element) {
    if (point.table == Table::coils && is_writable(point))
      add_switch(point, element);
    else if (!is_readable(point))
      warnings_.add("write-only registers are left out", "write them with the action modbus.write_register",
                    point.name);
    else if (holds_bits(point.table))
      entities_.binary_sensors +=
          head(point, element, read_range(point)) +
          fmt::format("{}input_type: {}\n", indent, point.table == Table::coils ? "coil" : "discrete_input");
    else
      add_register(point, element);
  }

  void add_switch(const Point& point, std::uint16_t element) {
    std::string& out = entities_.switches;
    out += head(point, element, range(point)) + fmt::format("{}write_type: coil\n", indent);
    if (is_readable(point))
      out +=
          fmt::format("{}verify:\n{}  input_type: coil\n{}  address: {}\n{}  state_on: 1\n{}  state_off: 0\n",
                      indent, indent, indent, read_range(point).start() + element, indent, indent);
  }

  void add_register(const Point& point, std::uint16_t element) {
    const auto input_type = fmt::format("{}input_type: {}\n", indent,
                                        point.table == Table::input_registers ? "input" : "holding");
    if (point.format.type == Type::BOOL) {
      if (codec::mask(point.format) != 1)
        warnings_.add("only the lowest bit of a register can be a binary sensor, so other bits are left out",
                      "make template binary sensors of the whole register", point.name);
      else
        entities_.binary_sensors += head(point, element, read_range(point)) + input_type;
      return;
    }
    std::string& out = entities_.sensors;
    out += head(point, element, read_range(point)) + input_type + format_keys(point, indent);
    if (point.scale.gain != 1) out += fmt::format("{}scale: {}\n", indent, point.scale.gain);
    if (point.scale.offset != 0) out += fmt::format("{}offset: {}\n", indent, point.scale.offset);
    if (const auto none = nan_value_of(point)) out += fmt::format("{}nan_value: {}\n", indent, *none);
    if (!point.units.empty()) out += fmt::format("{}unit_of_measurement: {}\n", indent, text(point.units));
    // Each sensor gets its id in the order of the file, because Home Assistant numbers sensors with equal
    // names in that order.
    const std::string id = sensor_ids_.make(entity_id(shown(name_of(point, element))), point.name);
    if (!point.values.empty()) add_template(name_of(point, element), id, point);
  }

  void add_template(const std::string& sensor, const std::string& id, const Point& point) {
    const std::string name = sensor + " name";
    template_ids_.emplace_back(entity_id(shown(name)), point.name);
    entities_.templates += fmt::format(
        "      - name: {}\n{}unique_id: {}\n{}state: {}\n{}availability: {}\n", text(shown(name)), indent,
        ids_.make(unique_id(map_, name), point.name), indent, text(state_template(point, id)), indent,
        text(fmt::format("{{{{ has_value('{}') }}}}", id)));
  }

  void add_warnings(const Point& point) {
    warn_of_raw_meaning(point, nan_value_of(point).has_value(), warnings_);
    if (is_readable(point) &&
        (point.host.rate > 0 ? point.host.rate : map_.polling.rate) > 1.0 / shortest_interval)
      warnings_.add("entities are read every 5 s, since shorter intervals make Home Assistant unstable",
                    "no action is needed", point.name);
    if (!point.description.empty())
      warnings_.add("descriptions are left out", "rename the entities", point.name);
    if (holds_bits(point.table)) {
      if (!point.units.empty())
        warnings_.add("switches and binary sensors have no units", "no action is needed", point.name);
      return;
    }
    if (is_writable(point) && is_readable(point))
      warnings_.add("holding registers become sensors, which cannot be written",
                    "use the action modbus.write_register", point.name);
    if (!point.values.empty())
      warnings_.add("names of values become template sensors, which read a sensor by its entity id",
                    "correct the ids under 'template:' if Home Assistant has given others", point.name);
    if (const std::string_view type = read_back_as(point.format.type); !type.empty())
      warnings_.add(fmt::format("an import reads {} back as {}", codec::to_string(point.format.type), type),
                    "keep the map", point.name);
    if (point.format.type == Type::STRING && point.format.length % 2 != 0)
      warnings_.add("texts of odd length have a byte more there", "keep that byte 0, which ends the text",
                    point.name);
    if (is_float(point.format.type))
      warnings_.add("floats are rounded to 6 decimals", "change 'precision' if that is too few", point.name);
    if (point.format.type == Type::STRING && point.format.encoding != codec::Encoding::utf8)
      warnings_.add("texts are read as UTF-8", "keep to ASCII in these points", point.name);
  }

  const Map& map_;
  ConversionWarnings& warnings_;
  UniqueNames ids_;
  UniqueNames sensor_ids_;
  std::vector<std::pair<std::string, std::string>> template_ids_;  ///< and their points
  Entities entities_;
};

std::string place_of(const Map& map) {
  const Connection& connection = map.connection;
  const Serial& line = connection.serial;
  if (line.present())
    return fmt::format(
        "    type: serial\n    method: rtu\n    port: {}\n    baudrate: {}\n    bytesize: 8\n    parity: {}\n"
        "    stopbits: {}\n",
        text(line.device), line.baud, parity_letter(line.parity), line.stop_bits);
  const std::string_view host = connection.address.empty() ? "localhost" : connection.address;
  return fmt::format("    type: {}\n    host: {}\n    port: {}\n", connection.is_rtu() ? "rtuovertcp" : "tcp",
                     text(host), port_without_tls(map));
}

std::string hub_of(const Map& map) {
  const auto seconds = [](std::chrono::milliseconds time) {
    return std::chrono::ceil<std::chrono::seconds>(time).count();
  };
  const double timeout = std::chrono::duration<double>(map.connection.timeout).count();
  std::string hub =
      fmt::format("modbus:\n  - name: {}\n{}    timeout: {}\n", text(map.name), place_of(map), timeout);
  if (map.limits.connect_delay.count() > 0)
    hub += fmt::format("    delay: {}\n", seconds(map.limits.connect_delay));
  if (map.limits.request_gap.count() > 0)
    hub += fmt::format("    message_wait_milliseconds: {}\n", map.limits.request_gap.count());
  return hub;
}

/// Warns that outputs that Home Assistant has switched on would go off again.
void warn_of_watchdog(const Map& map, ConversionWarnings& warnings) {
  if (!map.service.watchdog.present()) return;
  if (map.service.watchdog.fed_by == Watchdog::FedBy::write)
    return warnings.add(
        "Home Assistant does not repeat a command, so the node's watchdog with 'fed_by: write' takes each "
        "output to its safe state soon after it was switched",
        "remove 'fed_by: write' from the node's map, or repeat the command by an automation");
  int interval = std::numeric_limits<int>::max();
  for (const Point& point : map.points)
    if (is_readable(point)) interval = std::min(interval, interval_of(map, point));
  if (interval == std::numeric_limits<int>::max())
    return warnings.add("Home Assistant has nothing to read, so the node's watchdog is not fed",
                        "add a point that can be read to the map");
  const auto longest = std::chrono::seconds(interval);
  if (map.service.watchdog.timeout > 2 * longest) return;
  warnings.add(
      fmt::format("Home Assistant asks every {} s, and the node's watchdog takes the outputs that it has "
                  "switched to their safe state after {} s without a request",
                  interval, std::chrono::duration<double>(map.service.watchdog.timeout).count()),
      fmt::format("write 'watchdog: {{timeout: {}s}}' into the node's map", 3 * interval));
}

}  // namespace

Export write_home_assistant(const Map& map) {
  Export out;
  if (!map.connection.present())
    out.warnings.add("the map does not have the device's address, so localhost is written",
                     "write the address after 'host:'");
  if (map.connection.serial.present() && map.connection.serial.rs485)
    out.warnings.add("'rs485' is left out, since Home Assistant does not switch the direction of the line",
                     "use an adapter that does it by itself");
  const Entities entities = EntityWriter(map, out.warnings).write();
  warn_of_node_and_driver_keys(map, out.warnings);
  if (!entities.switches.empty()) warn_of_watchdog(map, out.warnings);
  warn_of_tools(map, out.warnings);
  warn_of_rights(map, true, out.warnings);
  out.text = "# Made by `coupler export --to home-assistant`.\n" + hub_of(map);
  if (!entities.binary_sensors.empty()) out.text += "    binary_sensors:\n" + entities.binary_sensors;
  if (!entities.switches.empty()) out.text += "    switches:\n" + entities.switches;
  if (!entities.sensors.empty()) out.text += "    sensors:\n" + entities.sensors;
  if (!entities.templates.empty()) out.text += "template:\n  - sensor:\n" + entities.templates;
  return out;
}

}  // namespace coupler::formats
