// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/base/span.hpp"

namespace coupler::modbus {

using Bytes = Span<const std::uint8_t>;

/// Modbus is big endian (MAP 4.2).
constexpr std::uint16_t get_u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] << 8 | at[1]);
}
constexpr void put_u16(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value >> 8);
  at[1] = static_cast<std::uint8_t>(value);
}

}  // namespace coupler::modbus
