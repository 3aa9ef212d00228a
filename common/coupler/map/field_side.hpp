// SPDX-License-Identifier: Apache-2.0
// The side of a simulated node's terminals that faces the machine. Under a unit id of its own, whoever plays
// the machine writes what the node reads, and reads what it drives.
#pragma once

#include <cstdint>

#include "coupler/map/table.hpp"

namespace coupler {

/// A node whose own unit id this is has no such side.
constexpr std::uint8_t field_unit = 247;

/// Returns the node's table for the table that a client of field_unit names: its coils are the node's
/// discrete inputs, its holding registers the node's input registers, and the other way round.
constexpr Table seen_from_field(Table table) {
  switch (table) {
    case Table::coils: return Table::discrete_inputs;
    case Table::discrete_inputs: return Table::coils;
    case Table::input_registers: return Table::holding_registers;
    case Table::holding_registers: break;
  }
  return Table::input_registers;
}

}  // namespace coupler
