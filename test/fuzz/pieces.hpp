// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "coupler/modbus/pdu.hpp"

namespace coupler::fuzz {

/// Takes the next piece off `input`: a byte says its size, which is `most` at most, and its bytes follow.
inline modbus::Bytes take_piece(modbus::Bytes& input, std::size_t most) {
  const std::size_t size = input.empty() ? 0 : std::min<std::size_t>({input[0], most, input.size() - 1});
  const modbus::Bytes taken = input.empty() ? input : input.sub(1, size);
  input = input.empty() ? input : input.from(1 + size);
  return taken;
}

}  // namespace coupler::fuzz
