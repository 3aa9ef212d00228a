// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

constexpr bool is_float(Type type) { return type == Type::REAL || type == Type::LREAL; }

/// The order of the bytes of a value in its registers. A is the most significant byte. Values of one register
/// have ABCD ("AB") and BADC ("BA") only.
enum class Order : std::uint8_t {
  ABCD,  ///< big endian throughout
  CDAB,  ///< registers reversed: the least significant register first
  BADC,  ///< the two bytes of each register swapped
  DCBA,  ///< both: little endian throughout
};
/// "AB" and "BA" are for values of one register.
constexpr Enumeration<Order, 6> enumeration(Order) {
  return {"Order",
          {{Order::ABCD, "ABCD"},
           {Order::CDAB, "CDAB"},
           {Order::BADC, "BADC"},
           {Order::DCBA, "DCBA"},
           {Order::ABCD, "ABCD", "AB"},
           {Order::BADC, "BADC", "BA"}}};
}

constexpr Order make_order(bool words_reversed, bool bytes_swapped) {
  if (words_reversed) return bytes_swapped ? Order::DCBA : Order::CDAB;
  return bytes_swapped ? Order::BADC : Order::ABCD;
}
constexpr bool words_reversed(Order order) { return order == Order::CDAB || order == Order::DCBA; }
constexpr bool bytes_swapped(Order order) { return order == Order::BADC || order == Order::DCBA; }

constexpr std::uint16_t swap_bytes(std::uint16_t word) {
  return static_cast<std::uint16_t>((word >> 8) | (word << 8));
}

/// "ABCD" …; for a value of one register "AB" or "BA".
constexpr std::string_view to_string(Order order, bool one_register) {
  if (one_register) return bytes_swapped(order) ? "BA" : "AB";
  return to_string(order);
}

/// The half of a register that holds an 8-bit value. `high` is the first byte on the wire in
/// big-endian order; with swapped bytes (Order::BADC) it is the second.
enum class Half : std::uint8_t { high, low };
constexpr Enumeration<Half, 2> enumeration(Half) {
  return {"Half", {{Half::high, "high"}, {Half::low, "low"}}};
}

enum class Encoding : std::uint8_t { utf8, ascii, latin1 };
constexpr Enumeration<Encoding, 3> enumeration(Encoding) {
  return {"Encoding",
          {{Encoding::utf8, "utf8", "utf-8"},
           {Encoding::ascii, "ascii"},
           {Encoding::latin1, "latin1", "latin-1"}}};
}

constexpr std::uint16_t longest_text = 250;  ///< bytes of a STRING: what one read may ask for

/// How one value stands in its registers (or, BOOL in a bit table, in one bit).
struct Format {
  Type type = Type::BOOL;
  Order order = Order::ABCD;  ///< ABCD or BADC for values of at most one register
  Half half = Half::high;     ///< 8-bit types
  /// BOOL in a register, and a number in some bits: the first one, 0 … 15, counted after the byte order is
  /// undone.
  std::uint8_t bit = 0;
  std::uint16_t length = 0;            ///< STRING: bytes, 1 … longest_text
  Encoding encoding = Encoding::utf8;  ///< STRING
  /// BYTE, USINT, WORD, UINT: the value has so many bits of its register, from `bit` on; 0: it has them all.
  std::uint8_t bits = 0;
};

/// The bits of a BOOL, or of a number that has some bits of its register; 0: it has a byte, or registers.
constexpr unsigned field_bits(const Format& format) { return format.type == Type::BOOL ? 1U : format.bits; }

/// The largest value in so many bits.
constexpr std::uint16_t largest_in(unsigned bits) { return static_cast<std::uint16_t>((1U << bits) - 1); }

/// A STRING stores its first character in the low byte, as BADC says, unless its point has `order: AB` or the
/// older `ignore_byteorder: true`, whatever the global keys say.
constexpr bool ignores_byte_order(const Format& format) {
  return format.type == Type::STRING && format.order == Order::ABCD;
}

/// The order as a map writes it. STRING has width 0: its order is AB or BA, as that of one register.
constexpr std::string_view order_text(const Format& format) {
  return to_string(format.order, width(format.type) <= 16);
}

/// Registers that the value touches. 8-bit values and bits touch one.
constexpr std::uint16_t registers(const Format& format) {
  if (format.type == Type::STRING) return static_cast<std::uint16_t>((format.length + 1) / 2);
  const unsigned bits = width(format.type);
  return static_cast<std::uint16_t>(bits <= 16 ? 1 : bits / 16);
}

/// The bits that the value occupies in its (only) register, as the register is sent; 0xFFFF for whole
/// registers.
constexpr std::uint16_t mask(const Format& format) {
  const bool swapped = bytes_swapped(format.order);
  if (field_bits(format) != 0) {
    const auto m = static_cast<std::uint16_t>(largest_in(field_bits(format)) << format.bit);
    return swapped ? swap_bytes(m) : m;
  }
  if (width(format.type) == 8) return (format.half == Half::high) != swapped ? 0xFF00 : 0x00FF;
  return 0xFFFF;
}

/// A value that shares its register with others: writing it needs the register's other bits.
constexpr bool is_partial(const Format& format) { return mask(format) != 0xFFFF; }

}  // namespace coupler::codec
