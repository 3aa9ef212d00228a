// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "coupler/modbus/pdu.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {

/// Takes the next piece off `input`: a byte says its size, which is `most` at most, and its bytes follow.
inline modbus::Bytes take_piece(modbus::Bytes& input, std::size_t most) {
  const std::size_t size = input.empty() ? 0 : std::min<std::size_t>({input[0], most, input.size() - 1});
  const modbus::Bytes taken = input.empty() ? input : input.sub(1, size);
  input = input.empty() ? input : input.from(1 + size);
  return taken;
}

/// Puts `bytes` into a framer, as much at a time as there is room for. `look()` is called after each part,
/// and says whether to go on.
template <class Framer, class Look>
void fill(Framer& framer, modbus::Bytes bytes, Look look) {
  while (!bytes.empty()) {
    const auto room = framer.room();
    require(!room.empty(), "there is always room");
    const modbus::Bytes part = bytes.first(std::min(room.size(), bytes.size()));
    std::copy(part.begin(), part.end(), room.begin());
    framer.filled(part.size());
    bytes = bytes.from(part.size());
    if (!look()) return;
  }
}

}  // namespace coupler::fuzz
