// SPDX-License-Identifier: Apache-2.0
// One number of T in its registers: what single values and arrays have in common.
#pragma once

#include "common/codec/number.hpp"

namespace coupler::driver {

template <class T>
T decode_element(const std::uint16_t* registers, const codec::Format& format) {
  if constexpr (sizeof(T) == 1)
    return static_cast<T>(codec::decode_part(registers[0], format));
  else
    return codec::decode<T>(registers, format.order);
}

/// Other bits of a shared register become zero.
template <class T>
void encode_element(T value, const codec::Format& format, std::uint16_t* registers) {
  if constexpr (sizeof(T) == 1)
    registers[0] = codec::encode_part(static_cast<std::uint8_t>(value), format);
  else
    codec::encode(value, format.order, registers);
}

}  // namespace coupler::driver
