// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace coupler::modbus {

/// Function codes (MAP 5.1) that this project speaks.
enum class Function : std::uint8_t {
  read_coils = 1,
  read_discrete_inputs = 2,
  read_holding_registers = 3,
  read_input_registers = 4,
  write_single_coil = 5,
  write_single_register = 6,
  diagnostics = 8,
  write_multiple_coils = 15,
  write_multiple_registers = 16,
  read_file_record = 20,
  mask_write_register = 22,
  read_write_multiple_registers = 23,
  encapsulated_interface = 43,
};

/// Set in the function code of a reply that is an exception (MAP 4.1). Function codes are 1 … 127.
constexpr std::uint8_t exception_bit = 0x80;

}  // namespace coupler::modbus
