// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/modbuspal_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/formats/entries.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

/// The type of a value that the binding's class feeds, and how many registers it has. ModbusPal's classes:
/// Binding_SINT16, Binding_SINT32, Binding_FLOAT32.
struct Fed {
  std::string_view type = "UINT";
  unsigned registers = 1;
};
Fed fed_by(std::string_view binding) {
  if (binding == "Binding_SINT16") return {"INT", 1};
  if (binding == "Binding_SINT32") return {"DINT", 2};
  if (binding == "Binding_FLOAT32") return {"REAL", 2};
  return {};
}

/// The two are the registers of one value, in one order or the other.
bool belong_together(const ModbusPalValue& a, const ModbusPalValue& b) {
  return a.binding == b.binding && a.address + 1 == b.address && a.rank + b.rank == 1;
}

Entry point_at(const ModbusPalValue& value, Table table) {
  const auto name = value.name.empty()
                        ? fmt::format("{}_{}", table == Table::coils ? "coil" : "hr", value.address)
                        : value.name;
  Entry point = section(name, value.at);
  point.children.push_back(scalar("address", fmt::to_string(value.address), value.at));
  return point;
}

/// What stands in the file is written unless it is the default; ModbusPal takes -32768 … 65535.
void add_initial(const ModbusPalValue& value, Table table, std::string_view type, Entry& point,
                 loader::Problems& problems) {
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

}  // namespace

Entry modbuspal_points(std::vector<ModbusPalValue> values, Table table, loader::Problems& problems) {
  std::stable_sort(values.begin(), values.end(),
                   [](const ModbusPalValue& a, const ModbusPalValue& b) { return a.address < b.address; });
  Entry points = section(to_string(table), values.empty() ? loader::Position{} : values.front().at);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ModbusPalValue& value = values[i];
    Entry point = point_at(value, table);
    if (table == Table::coils) {
      add_initial(value, table, "BOOL", point, problems);
    } else {
      Fed fed = fed_by(value.binding);
      const bool pair = fed.registers == 2 && i + 1 < values.size() && belong_together(value, values[i + 1]);
      if (fed.registers == 2 && !pair) {
        problems.warning(
            value.at, fmt::format("the other register of a {} is not beside it: it is a UINT here", fed.type),
            "look at what the two hold");
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

}  // namespace coupler::formats
