// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/map/map.hpp"
#include "common/modbus/limits.hpp"
#include "host/core/transport.hpp"

namespace coupler::driver {

/// A value on its way to the device, encoded. It owns its registers, so that a queue of them allocates
/// nothing.
struct Write {
  std::uint32_t point = 0;                                            ///< index into Map::points
  std::array<std::uint16_t, modbus::max_read_registers> registers{};  ///< codec::registers(point.format) are
                                                                      ///< used; coils: the first, 0 or 1
};

/// Carries it out. A point that shares its register with others changes only its own bits: by FC 22 where the
/// device has it, otherwise by reading the register and writing it back.
Result<> perform(const Write& write, const Map& map, Transport& transport);

}  // namespace coupler::driver
