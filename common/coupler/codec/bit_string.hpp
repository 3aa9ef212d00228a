// SPDX-License-Identifier: Apache-2.0
// IEC 61131-3's bit strings, BYTE to LWORD: bits side by side and no number, so people read them in
// hexadecimal.
#pragma once

#include <string>

#include "coupler/codec/value.hpp"

namespace coupler::codec {

constexpr bool is_bit_string(Type type) {
  return type == Type::BYTE || type == Type::WORD || type == Type::DWORD || type == Type::LWORD;
}

/// A value of the type for people: bit strings with all their digits, as "0x00FF", others as to_string() has
/// them.
std::string text_of(const Value& value, Type type);

}  // namespace coupler::codec
