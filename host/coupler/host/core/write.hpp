// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "coupler/host/core/write_result.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::host {

/// A value on its way to the device, encoded. It owns its registers, so that a queue of them allocates
/// nothing.
struct Write {
  std::uint32_t point = 0;  ///< index into Map::points
  /// range(point).count() of them are used. Coils: bit i % 16 of element i / 16, so that one coil is the
  /// first, 0 or 1.
  std::array<std::uint16_t, modbus::max_read_registers> registers{};
  bool ordered = false;               ///< keeps its place in the queue: its caller waits for its own result
  bool of_deadman = false;            ///< made by the driver because no message came
  WriteListener* listener = nullptr;  ///< told what became of it; lives until then

  bool bit(std::size_t i) const { return (registers[i / 16] >> i % 16 & 1U) != 0; }
  void set_bit(std::size_t i) {
    registers[i / 16] = static_cast<std::uint16_t>(registers[i / 16] | 1U << i % 16);
  }
};

/// A value as a point's `initial`, `safe_value` and deadman give it: bit tables one element a bit. Empty is
/// all zero.
Write make_write(const Map& map, std::uint32_t point, Span<const std::uint16_t> value);

/// Whether none of its floats is NaN or infinite.
bool is_finite(const Point& point, const Write& write);

}  // namespace coupler::host
