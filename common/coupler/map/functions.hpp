// SPDX-License-Identifier: Apache-2.0
// Which function codes read and write the points of a map (MAP 6).
#pragma once

#include <cstddef>

#include "coupler/map/point.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler {

constexpr modbus::Function read_function(Table table) {
  switch (table) {
    case Table::coils: return modbus::Function::read_coils;
    case Table::discrete_inputs: return modbus::Function::read_discrete_inputs;
    case Table::input_registers: return modbus::Function::read_input_registers;
    case Table::holding_registers: break;
  }
  return modbus::Function::read_holding_registers;
}

/// The table that FC 1, 2, 3 or 4 reads.
constexpr Table table_of(modbus::Function read) {
  switch (read) {
    case modbus::Function::read_coils: return Table::coils;
    case modbus::Function::read_discrete_inputs: return Table::discrete_inputs;
    case modbus::Function::read_input_registers: return Table::input_registers;
    default: return Table::holding_registers;
  }
}

/// Returns the function code for `count` coils or holding registers in one request. A single one has a
/// function code of its own, unless the map wants the other one.
constexpr modbus::Function write_function(Table table, std::size_t count, HostOptions::WriteFunction wanted) {
  const bool single = count == 1 && wanted != HostOptions::WriteFunction::multiple;
  if (table == Table::coils)
    return single ? modbus::Function::write_single_coil : modbus::Function::write_multiple_coils;
  return single ? modbus::Function::write_single_register : modbus::Function::write_multiple_registers;
}

}  // namespace coupler
