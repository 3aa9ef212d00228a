// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace coupler {

/// The four address spaces of a Modbus device (MAP 4.3).
enum class Table : std::uint8_t { coils, discrete_inputs, input_registers, holding_registers };

constexpr std::array<Table, 4> tables{Table::coils, Table::discrete_inputs, Table::input_registers,
                                      Table::holding_registers};

constexpr bool holds_bits(Table table) { return table == Table::coils || table == Table::discrete_inputs; }
constexpr bool is_writable(Table table) { return table == Table::coils || table == Table::holding_registers; }
constexpr std::size_t index(Table table) { return static_cast<std::size_t>(table); }

/// The key under `mapping:`.
constexpr std::string_view to_string(Table table) {
  switch (table) {
    case Table::coils: return "coils";
    case Table::discrete_inputs: return "discrete_inputs";
    case Table::input_registers: return "input_registers";
    case Table::holding_registers: return "holding_registers";
  }
  return "?";
}

}  // namespace coupler
