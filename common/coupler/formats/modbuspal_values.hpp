// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/table.hpp"

namespace coupler::formats {

/// One register or coil of a ModbusPal project.
struct ModbusPalValue {
  loader::Position at;
  unsigned address = 0;
  std::string name;  ///< may be empty
  std::string value;
  std::string binding;  ///< the class that feeds it, "Binding_SINT32"; empty: none
  unsigned rank = 0;    ///< which register of the fed value it is: 0 the least significant
};

/// The points of one table, in the order of their addresses. Neighbours that are the two registers of one fed
/// value become one point.
loader::Entry modbuspal_points(std::vector<ModbusPalValue> values, Table table, loader::Problems& problems);

}  // namespace coupler::formats
