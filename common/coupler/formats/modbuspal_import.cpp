// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/importers.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "coupler/formats/entries.hpp"
#include "coupler/formats/modbuspal_values.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;
using loader::shown;

/// Where nodes stand, quickly, however many there are.
class Lines {
 public:
  explicit Lines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }

  Position at(std::ptrdiff_t offset) const {
    const auto place = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), place);
    return {static_cast<int>(after - starts_.begin()), static_cast<int>(place - *(after - 1)) + 1};
  }

 private:
  std::vector<std::size_t> starts_{0};
};

class ProjectReader {
 public:
  ProjectReader(const Lines& lines, Problems& problems) : lines_(lines), problems_(problems) {}

  std::vector<ForeignUnit> read(const pugi::xml_node& project) {
    std::vector<ForeignUnit> units;
    for (const pugi::xml_node& node : project) {
      if (std::strcmp(node.name(), "slave") == 0)
        units.push_back(read_slave(node, project));
      else if (node.type() == pugi::node_element && std::strcmp(node.name(), "idgen") != 0 &&
               std::strcmp(node.name(), "links") != 0)
        left_out(node, fmt::format("'{}' of the simulation", node.name()));
    }
    if (units.empty())
      problems_.error(at(project), "there are no slaves in the project", "give a project that has some");
    return units;
  }

 private:
  Position at(const pugi::xml_node& node) const { return lines_.at(node.offset_debug()); }

  void left_out(const pugi::xml_node& node, const std::string& what) {
    problems_.warning(at(node),
                      what + " is not carried over: a map describes what there is, not how it moves",
                      "nothing is to be done");
  }

  /// "5", or "192.168.0.7(5)".
  void read_id(const pugi::xml_node& slave, ForeignUnit& unit) {
    const std::string_view id = slave.attribute("id").value();
    const std::size_t bracket = id.find('(');
    std::string_view number = id;
    if (bracket != std::string_view::npos && id.back() == ')') {
      number = id.substr(bracket + 1, id.size() - bracket - 2);
      if (bracket > 0)
        unit.map.children.push_back(scalar("address", std::string(id.substr(0, bracket)), at(slave), true));
    }
    const auto value = loader::parse_unsigned(number);
    if (value && *value <= 255)
      unit.unit = static_cast<unsigned>(*value);
    else
      problems_.error(at(slave), fmt::format("{} is not a unit id", shown(id)),
                      "give the slave a number from 0 to 255");
  }

  ForeignUnit read_slave(const pugi::xml_node& slave, const pugi::xml_node& project) {
    ForeignUnit unit;
    unit.map = section("", at(slave));
    read_id(slave, unit);
    if (const auto port = project.child("links").child("tcpip").attribute("port"))
      unit.map.children.push_back(scalar("port", port.value(), at(project.child("links").child("tcpip"))));
    if (slave.attribute("enabled").value() == std::string_view("false"))
      problems_.warning(at(slave), "that the slave is switched off is not carried over",
                        "leave its map out if it is not there");
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
    std::vector<ModbusPalValue> values;
    std::set<unsigned> seen;
    for (const pugi::xml_node& node : part.children(element)) {
      const auto address = loader::parse_unsigned(node.attribute("address").value());
      if (!address || *address > 65535) {
        problems_.error(at(node),
                        fmt::format("{} is not an address", shown(node.attribute("address").value())),
                        "write a number from 0 to 65535");
      } else if (!seen.insert(static_cast<unsigned>(*address)).second) {
        problems_.warning(at(node),
                          fmt::format("{} {} is there twice, this one is left out", element, *address),
                          "keep one of the two");
      } else {
        values.push_back(read_value(node, static_cast<unsigned>(*address)));
      }
    }
    Entry points = modbuspal_points(std::move(values), table, problems_);
    if (!points.children.empty()) mapping.children.push_back(std::move(points));
  }

  ModbusPalValue read_value(const pugi::xml_node& node, unsigned address) {
    ModbusPalValue value;
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

  const Lines& lines_;
  Problems& problems_;
};

/// Of a declaration only its name is taken; what it declares is never read.
bool check_declaration(const pugi::xml_document& document, const Lines& lines, Problems& problems) {
  for (const pugi::xml_node& node : document) {
    if (node.type() != pugi::node_doctype || std::strchr(node.value(), '[') == nullptr) continue;
    problems.error(lines.at(node.offset_debug()),
                   "the file declares entities of its own, which ModbusPal never writes",
                   "remove what stands between '[' and ']' behind DOCTYPE");
    return false;
  }
  return true;
}

}  // namespace

std::vector<ForeignUnit> read_modbuspal(std::string_view text, Problems& problems) {
  const Lines lines(text);
  pugi::xml_document document;
  const auto outcome = document.load_buffer(text.data(), text.size(),
                                            pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (!outcome) {
    problems.error(lines.at(outcome.offset), fmt::format("this is not XML: {}", outcome.description()),
                   "give a project that ModbusPal saved");
    return {};
  }
  if (!check_declaration(document, lines, problems)) return {};
  const pugi::xml_node project = document.child("modbuspal_project");
  if (!project) {
    problems.error({1, 1}, "there is no <modbuspal_project> in the file",
                   "give a project that ModbusPal saved");
    return {};
  }
  return ProjectReader(lines, problems).read(project);
}

}  // namespace coupler::formats
