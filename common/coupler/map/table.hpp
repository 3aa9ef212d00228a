// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "coupler/base/enumeration.hpp"

namespace coupler {

/// The four address spaces of a Modbus device (MAP 4.3).
enum class Table : std::uint8_t { coils, discrete_inputs, input_registers, holding_registers };

constexpr std::array<Table, 4> tables{Table::coils, Table::discrete_inputs, Table::input_registers,
                                      Table::holding_registers};

constexpr bool holds_bits(Table table) { return table == Table::coils || table == Table::discrete_inputs; }
constexpr bool is_writable(Table table) { return table == Table::coils || table == Table::holding_registers; }
constexpr std::size_t index(Table table) { return static_cast<std::size_t>(table); }

/// The keys under `mapping:`.
constexpr Enumeration<Table, 4> enumeration(Table) {
  return {"Table",
          {{Table::coils, "coils"},
           {Table::discrete_inputs, "discrete_inputs"},
           {Table::input_registers, "input_registers"},
           {Table::holding_registers, "holding_registers"}}};
}

}  // namespace coupler
