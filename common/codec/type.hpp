// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace coupler::codec {

/// Data types of IEC 61131-3 (2013), table 10, as far as they fit into registers.
/// BOOL is a coil, a discrete input, or one bit of a register.
enum class Type : std::uint8_t {
  BOOL,
  BYTE,
  WORD,
  DWORD,
  LWORD,
  SINT,
  INT,
  DINT,
  LINT,
  USINT,
  UINT,
  UDINT,
  ULINT,
  REAL,
  LREAL,
  CHAR,
  STRING,
};

/// Width of one value in bits; 0 for STRING, whose width is its length.
constexpr unsigned width(Type type) {
  switch (type) {
    case Type::BOOL: return 1;
    case Type::BYTE:
    case Type::SINT:
    case Type::USINT:
    case Type::CHAR: return 8;
    case Type::WORD:
    case Type::INT:
    case Type::UINT: return 16;
    case Type::DWORD:
    case Type::DINT:
    case Type::UDINT:
    case Type::REAL: return 32;
    case Type::LWORD:
    case Type::LINT:
    case Type::ULINT:
    case Type::LREAL: return 64;
    case Type::STRING: return 0;
  }
  return 0;
}

std::string_view to_string(Type type);

/// The type of that name, in any case ("uint", "UINT").
std::optional<Type> parse_type(std::string_view name);

}  // namespace coupler::codec
