// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/foreign_connection.hpp"
#include "coupler/tools/formats/map_tree.hpp"
#include "coupler/tools/formats/xml_places.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;
using loader::shown;

/// One register or coil of a ModbusPal project.
struct Value {
  Position at;
  unsigned address = 0;
  std::string name;  ///< may be empty
  std::string value;
  std::string binding;  ///< the class that feeds it, "Binding_SINT32"; empty: none
  unsigned rank = 0;    ///< which register of the fed value it is: 0 the least significant
};

/// The type of a value that the binding's class feeds, and how many registers it has. ModbusPal's classes are
/// Binding_SINT16, Binding_SINT32 and Binding_FLOAT32.
struct Fed {
  std::string_view type = "UINT";
  unsigned registers = 1;
};
Fed fed_by(std::string_view binding) {
  constexpr std::string_view prefix = "Binding_";
  if (binding.substr(0, prefix.size()) != prefix) return {};
  const auto type = codec::parse_type(binding.substr(prefix.size()));
  if (!type || (codec::width(*type) != 16 && codec::width(*type) != 32)) return {};
  return {to_string(*type), codec::width(*type) / 16};
}

/// The two are the registers of one value, in one order or the other.
bool belong_together(const Value& a, const Value& b) {
  return a.binding == b.binding && a.address + 1 == b.address && a.rank + b.rank == 1;
}

Entry point_at(const Value& value, Table table) {
  const auto name = value.name.empty()
                        ? fmt::format("{}_{}", table == Table::coils ? "coil" : "hr", value.address)
                        : value.name;
  Entry point = section(name, value.at);
  point.children.push_back(scalar("address", fmt::to_string(value.address), value.at));
  return point;
}

/// A value in the file is written unless it is the default. ModbusPal takes -32768 to 65535.
void add_initial(const Value& value, Table table, std::string_view type, Entry& point, Problems& problems) {
  const auto number = loader::parse_integer(value.value);
  const bool fits = number && *number >= -32768 && *number <= 65535;
  if (!fits)
    problems.error(value.at, fmt::format("the value {} is not a register value", shown(value.value)),
                   "write a number from -32768 to 65535");
  else if (*number != 0 && table == Table::coils)
    point.children.push_back(scalar("initial", "on", value.at));
  else if (*number != 0 && type == "UINT")
    point.children.push_back(scalar("initial", fmt::to_string(*number & 0xFFFF), value.at));
}

/// The points of one table, in the order of their addresses. Neighbours that are the two registers of one fed
/// value become one point.
Entry points_of(std::vector<Value> values, Table table, Problems& problems) {
  std::stable_sort(values.begin(), values.end(),
                   [](const Value& a, const Value& b) { return a.address < b.address; });
  Entry points = section(to_string(table), values.empty() ? Position{} : values.front().at);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Value& value = values[i];
    Entry point = point_at(value, table);
    if (table == Table::coils) {
      add_initial(value, table, "BOOL", point, problems);
    } else {
      Fed fed = fed_by(value.binding);
      const bool pair = fed.registers == 2 && i + 1 < values.size() && belong_together(value, values[i + 1]);
      if (fed.registers == 2 && !pair) {
        problems.warning(
            value.at,
            fmt::format("the other register of a {} is not next to this one, so this one is a UINT",
                        fed.type),
            "check what the two registers hold");
        fed = {};
      }
      point.children.push_back(scalar("type", std::string(fed.type), value.at));
      if (pair) point.children.push_back(scalar("order", value.rank == 0 ? "CDAB" : "ABCD", value.at));
      add_initial(value, table, fed.type, point, problems);
      if (pair) ++i;
    }
    points.children.push_back(std::move(point));
  }
  return points;
}

class ProjectReader {
 public:
  ProjectReader(const XmlPlaces& places, Problems& problems) : places_(places), problems_(problems) {}

  std::vector<ForeignUnit> read(const pugi::xml_node& project) {
    std::vector<ForeignUnit> units;
    read_links(project.child("links"));
    for (const pugi::xml_node& node : project) {
      if (std::strcmp(node.name(), "slave") == 0)
        units.push_back(read_slave(node));
      else if (node.type() == pugi::node_element && std::strcmp(node.name(), "idgen") != 0 &&
               std::strcmp(node.name(), "links") != 0)
        left_out(node, fmt::format("'{}' of the simulation", node.name()));
    }
    if (units.empty())
      problems_.error(at(project), "there is no slave in the project",
                      "give a project with at least one slave");
    return units;
  }

 private:
  Position at(const pugi::xml_node& node) const { return places_.at(node.offset_debug()); }

  void left_out(const pugi::xml_node& node, const std::string& what) {
    problems_.warning(at(node), what + " is not carried over: a map does not simulate values",
                      "no action is needed");
  }

  /// The link that was chosen when the project was saved. The defaults are ModbusPal's.
  void read_links(const pugi::xml_node& links) {
    constexpr LineKeys keys = {"com", "baudrate", "", "parity", "stops", "9600", "even", "1"};
    is_serial_ = lower(links.attribute("selected").value()) == "serial";
    if (!is_serial_) {
      if (const auto port = links.child("tcpip").attribute("port"))
        connection_.push_back(scalar("port", port.value(), at(links.child("tcpip"))));
      return;
    }
    const pugi::xml_node serial = links.child("serial");
    Entry line = section("serial", at(serial ? serial : links));
    for (const std::string_view key : {keys.device, keys.baud, keys.parity, keys.stop_bits})
      if (const pugi::xml_attribute given = serial.attribute(std::string(key).c_str()))
        line.children.push_back(scalar(key, given.value(), places_.attribute(serial.offset_debug(), key)));
    connection_.push_back(read_serial_line(line, keys, problems_));
    const pugi::xml_node flow_control = serial.child("flowcontrol");
    for (const char* key : {"xonxoff", "rtscts"})
      if (flow_control.attribute(key).as_bool())
        problems_.warning(places_.attribute(flow_control.offset_debug(), key),
                          fmt::format("the flow control '{}' is not carried over: RTU has none", key),
                          "switch it off in the device");
  }

  /// "5", or "192.168.0.7(5)".
  void read_id(const pugi::xml_node& slave, ForeignUnit& unit) {
    const std::string_view id = slave.attribute("id").value();
    const std::size_t bracket = id.find('(');
    std::string_view number = id;
    if (bracket != std::string_view::npos && id.back() == ')') {
      number = id.substr(bracket + 1, id.size() - bracket - 2);
      if (bracket > 0 && !is_serial_)
        unit.map.children.push_back(scalar("address", std::string(id.substr(0, bracket)), at(slave), true));
    }
    const auto value = loader::parse_unsigned(number);
    if (value && *value <= 255)
      unit.unit = static_cast<unsigned>(*value);
    else
      problems_.error(at(slave), fmt::format("{} is not a unit id", shown(id)),
                      "give the slave a number from 0 to 255");
  }

  ForeignUnit read_slave(const pugi::xml_node& slave) {
    ForeignUnit unit;
    unit.map = section("", at(slave));
    read_id(slave, unit);
    unit.map.children.insert(unit.map.children.end(), connection_.begin(), connection_.end());
    if (slave.attribute("enabled").value() == std::string_view("false"))
      problems_.warning(at(slave), "the slave is switched off in the project, which a map cannot express",
                        "delete its map if the device does not exist");
    if (const std::string_view name = slave.attribute("name").value(); !name.empty())
      problems_.warning(at(slave), fmt::format("the slave's name {} is not carried over", shown(name)),
                        "give the map a name with --name");
    Entry mapping = section("mapping", at(slave));
    for (const pugi::xml_node& part : slave) read_part(part, mapping);
    unit.map.children.push_back(std::move(mapping));
    return unit;
  }

  void read_part(const pugi::xml_node& part, Entry& mapping) {
    const std::string_view name = part.name();
    if (name == "holding_registers")
      read_table(part, "register", Table::holding_registers, mapping);
    else if (name == "coils")
      read_table(part, "coil", Table::coils, mapping);
    else if (part.type() == pugi::node_element &&
             (name == "extended_registers" ? bool(part.first_child()) : true))
      left_out(part, fmt::format("'{}' of the slave", name));
  }

  void read_table(const pugi::xml_node& part, const char* element, Table table, Entry& mapping) {
    std::vector<Value> values;
    std::set<unsigned> seen;
    for (const pugi::xml_node& node : part.children(element)) {
      const auto address = loader::parse_unsigned(node.attribute("address").value());
      if (!address || *address > 65535) {
        problems_.error(at(node),
                        fmt::format("{} is not an address", shown(node.attribute("address").value())),
                        "write a number from 0 to 65535");
      } else if (!seen.insert(static_cast<unsigned>(*address)).second) {
        problems_.warning(at(node),
                          fmt::format("{} {} is there twice, so this one is left out", element, *address),
                          "keep one of the two");
      } else {
        values.push_back(read_value(node, static_cast<unsigned>(*address)));
      }
    }
    Entry points = points_of(std::move(values), table, problems_);
    if (!points.children.empty()) mapping.children.push_back(std::move(points));
  }

  Value read_value(const pugi::xml_node& node, unsigned address) {
    Value value;
    value.at = at(node);
    value.address = address;
    value.name = node.attribute("name").value();
    value.value = node.attribute("value").as_string("0");
    if (const pugi::xml_node binding = node.child("binding")) {
      value.binding = binding.attribute("class").value();
      value.rank = binding.attribute("order").as_uint();
      left_out(binding, fmt::format("the automation {}", shown(binding.attribute("automation").value())));
    }
    return value;
  }

  const XmlPlaces& places_;
  Problems& problems_;
  bool is_serial_ = false;
  std::vector<Entry> connection_;  ///< of all slaves
};

/// Refuses a DOCTYPE that declares entities. None is ever read.
bool check_declaration(const pugi::xml_document& document, const XmlPlaces& places, Problems& problems) {
  for (const pugi::xml_node& node : document) {
    if (node.type() != pugi::node_doctype || std::strchr(node.value(), '[') == nullptr) continue;
    problems.error(places.at(node.offset_debug()),
                   "the file declares entities of its own, which ModbusPal never writes",
                   "remove what stands between '[' and ']' after DOCTYPE");
    return false;
  }
  return true;
}

}  // namespace

std::vector<ForeignUnit> read_modbuspal(std::string_view text, const ImportOptions& /*options*/,
                                        Problems& problems) {
  const XmlPlaces places(text);
  pugi::xml_document document;
  const auto outcome = document.load_buffer(text.data(), text.size(),
                                            pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (!outcome) {
    problems.error(places.at(outcome.offset), fmt::format("this is not XML: {}", outcome.description()),
                   "give a project that ModbusPal saved");
    return {};
  }
  if (!check_declaration(document, places, problems)) return {};
  const pugi::xml_node project = document.child("modbuspal_project");
  if (!project) {
    problems.error({1, 1}, "there is no <modbuspal_project> in the file",
                   "give a project that ModbusPal saved");
    return {};
  }
  return ProjectReader(places, problems).read(project);
}

}  // namespace coupler::formats
