// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/enumeration.hpp"

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
constexpr Enumeration<Type, 17> enumeration(Type) {
  return {"Type",
          {{Type::BOOL, "BOOL"},
           {Type::BYTE, "BYTE"},
           {Type::WORD, "WORD"},
           {Type::DWORD, "DWORD"},
           {Type::LWORD, "LWORD"},
           {Type::SINT, "SINT"},
           {Type::INT, "INT"},
           {Type::DINT, "DINT"},
           {Type::LINT, "LINT"},
           {Type::USINT, "USINT"},
           {Type::UINT, "UINT"},
           {Type::UDINT, "UDINT"},
           {Type::ULINT, "ULINT"},
           {Type::REAL, "REAL"},
           {Type::LREAL, "LREAL"},
           {Type::CHAR, "CHAR"},
           {Type::STRING, "STRING"}}};
}
using coupler::to_string;

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

/// The type of that name, in any case ("uint", "UINT").
std::optional<Type> parse_type(std::string_view name);

}  // namespace coupler::codec
