// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"
#include "coupler/codec/order.hpp"
#include "coupler/codec/type.hpp"

namespace coupler::codec {

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

/// How one value stands in its registers (or, BOOL in a bit table, in one bit).
struct Format {
  Type type = Type::BOOL;
  Order order = Order::ABCD;  ///< ABCD or BADC for values of at most one register
  Half half = Half::high;     ///< 8-bit types
  std::uint8_t bit = 0;       ///< BOOL in a register: 0 … 15, counted after the byte order is undone
  std::uint16_t length = 0;   ///< STRING: bytes, 1 … 250
  Encoding encoding = Encoding::utf8;  ///< STRING
};

/// A STRING stores its first character in the low byte unless the map says `ignore_byteorder`: its order is
/// BADC by default and ABCD with `ignore_byteorder: true`, whatever the global keys say.
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

/// The bits of its (only) register that the value occupies, as they stand on the wire; 0xFFFF for whole
/// registers.
constexpr std::uint16_t mask(const Format& format) {
  const bool swapped = bytes_swapped(format.order);
  if (format.type == Type::BOOL) {
    const auto m = static_cast<std::uint16_t>(1U << format.bit);
    return swapped ? swap_bytes(m) : m;
  }
  if (width(format.type) == 8) return (format.half == Half::high) != swapped ? 0xFF00 : 0x00FF;
  return 0xFFFF;
}

/// A value that shares its register with others: writing it needs the register's other bits.
constexpr bool is_partial(const Format& format) { return mask(format) != 0xFFFF; }

}  // namespace coupler::codec
