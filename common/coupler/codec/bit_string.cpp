// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/bit_string.hpp"

#include <fmt/format.h>

namespace coupler::codec {

std::string text_of(const Value& value, Type type) {
  const auto* bits = std::get_if<std::uint64_t>(&value);
  if (bits == nullptr || !is_bit_string(type)) return to_string(value);
  return fmt::format("0x{:0{}X}", *bits, width(type) / 4);
}

}  // namespace coupler::codec
