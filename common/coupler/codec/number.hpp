// SPDX-License-Identifier: Apache-2.0
// Numbers <-> registers. No heap, no exceptions; the compiler sees the type, so a poll's inner loop has no
// branches on it.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "coupler/codec/format.hpp"

namespace coupler::codec {
namespace detail {

template <std::size_t Bytes>
struct Unsigned;
template <>
struct Unsigned<1> {
  using type = std::uint8_t;
};
template <>
struct Unsigned<2> {
  using type = std::uint16_t;
};
template <>
struct Unsigned<4> {
  using type = std::uint32_t;
};
template <>
struct Unsigned<8> {
  using type = std::uint64_t;
};

template <class To, class From>
To bit_cast(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

}  // namespace detail

/// The value of `sizeof(T) / 2` registers (T: 16, 32 or 64 bits wide).
template <class T>
T decode(const std::uint16_t* registers, Order order) {
  using U = typename detail::Unsigned<sizeof(T)>::type;
  constexpr std::size_t n = sizeof(T) / 2;
  static_assert(n >= 1, "8-bit values: decode_half");
  U raw = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint16_t word = registers[words_reversed(order) ? n - 1 - i : i];
    if (bytes_swapped(order)) word = swap_bytes(word);
    if constexpr (n == 1)
      raw = word;
    else
      raw = static_cast<U>(raw << 16U) | word;
  }
  return detail::bit_cast<T>(raw);
}

/// Writes `value` into `sizeof(T) / 2` registers.
template <class T>
void encode(T value, Order order, std::uint16_t* registers) {
  using U = typename detail::Unsigned<sizeof(T)>::type;
  constexpr std::size_t n = sizeof(T) / 2;
  static_assert(n >= 1, "8-bit values: encode_part");
  const U raw = detail::bit_cast<U>(value);
  for (std::size_t i = 0; i < n; ++i) {
    auto word = static_cast<std::uint16_t>(raw >> (16U * (n - 1 - i)));
    if (bytes_swapped(order)) word = swap_bytes(word);
    registers[words_reversed(order) ? n - 1 - i : i] = word;
  }
}

/// The byte or the bits that a partial format selects from its register; of a BOOL, 0 or 1.
constexpr std::uint16_t decode_part(std::uint16_t word, const Format& format) {
  if (const unsigned bits = field_bits(format); bits != 0) {
    if (bytes_swapped(format.order)) word = swap_bytes(word);
    return static_cast<std::uint16_t>((word >> format.bit) & largest_in(bits));
  }
  return static_cast<std::uint16_t>(mask(format) == 0xFF00 ? word >> 8 : word & 0xFF);
}

/// The value in its place in the register, all other bits zero: combine with `(word & ~mask(format))`. The
/// part has room for it.
constexpr std::uint16_t encode_part(std::uint16_t value, const Format& format) {
  if (field_bits(format) != 0) {
    if (format.type == Type::BOOL) value = value != 0 ? 1 : 0;
    const auto word = static_cast<std::uint16_t>(value << format.bit);
    return bytes_swapped(format.order) ? swap_bytes(word) : word;
  }
  return mask(format) == 0xFF00 ? static_cast<std::uint16_t>(value << 8) : value;
}

/// Returns whether the bits that the format has are enough for a value of its type.
template <class T>
constexpr bool has_room(T value, const Format& format) {
  if constexpr (std::is_unsigned_v<T> && sizeof(T) <= 2)
    return format.bits == 0 || value <= largest_in(format.bits);
  else
    return true;
}

/// A value of this type may be one of the parts of a register.
template <class T>
constexpr bool may_be_partial = std::is_integral_v<T> && sizeof(T) <= 2;

/// The value of a type of any width.
template <class T>
T take(const Format& format, const std::uint16_t* registers) {
  if constexpr (sizeof(T) == 1)
    return static_cast<T>(decode_part(registers[0], format));
  else if constexpr (may_be_partial<T>)
    return format.bits != 0 ? static_cast<T>(decode_part(registers[0], format))
                            : decode<T>(registers, format.order);
  else
    return decode<T>(registers, format.order);
}

/// Writes a value of any width, for which the format has room; the other bits of a shared register stay.
template <class T>
void put(T value, const Format& format, std::uint16_t* registers) {
  if constexpr (may_be_partial<T>) {
    if (sizeof(T) == 1 || format.bits != 0) {
      using U = typename detail::Unsigned<sizeof(T)>::type;
      const auto kept = static_cast<std::uint16_t>(registers[0] & ~mask(format));
      registers[0] = static_cast<std::uint16_t>(kept | encode_part(static_cast<U>(value), format));
      return;
    }
  }
  if constexpr (sizeof(T) > 1) encode(value, format.order, registers);
}

/// Calls f with a zero of the C++ type that stands for the IEC type (all but STRING).
template <class F>
auto with_number(Type type, F&& f) {
  switch (type) {
    case Type::SINT: return f(std::int8_t{});
    case Type::WORD:
    case Type::UINT: return f(std::uint16_t{});
    case Type::INT: return f(std::int16_t{});
    case Type::DWORD:
    case Type::UDINT: return f(std::uint32_t{});
    case Type::DINT: return f(std::int32_t{});
    case Type::LWORD:
    case Type::ULINT: return f(std::uint64_t{});
    case Type::LINT: return f(std::int64_t{});
    case Type::REAL: return f(float{});
    case Type::LREAL: return f(double{});
    default: return f(std::uint8_t{});  // BOOL, BYTE, USINT, CHAR
  }
}

}  // namespace coupler::codec
