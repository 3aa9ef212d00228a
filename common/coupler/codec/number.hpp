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

/// The byte (or, for BOOL, the bit as 0 or 1) that a partial format selects from its register.
constexpr std::uint8_t decode_part(std::uint16_t word, const Format& format) {
  const std::uint16_t m = mask(format);
  if (format.type == Type::BOOL) return (word & m) != 0 ? 1 : 0;
  return static_cast<std::uint8_t>(m == 0xFF00 ? word >> 8 : word & 0xFF);
}

/// The value in its place in the register, all other bits zero: combine with `(word & ~mask(format))`.
constexpr std::uint16_t encode_part(std::uint8_t value, const Format& format) {
  const std::uint16_t m = mask(format);
  if (format.type == Type::BOOL) return value != 0 ? m : std::uint16_t{0};
  return m == 0xFF00 ? static_cast<std::uint16_t>(value << 8) : std::uint16_t{value};
}

/// The value of a type of any width.
template <class T>
T take(const Format& format, const std::uint16_t* registers) {
  if constexpr (sizeof(T) == 1)
    return static_cast<T>(decode_part(registers[0], format));
  else
    return decode<T>(registers, format.order);
}

/// Writes a value of any width; the other bits of a shared register stay.
template <class T>
void put(T value, const Format& format, std::uint16_t* registers) {
  if constexpr (sizeof(T) == 1) {
    const auto kept = static_cast<std::uint16_t>(registers[0] & ~mask(format));
    registers[0] = static_cast<std::uint16_t>(kept | encode_part(static_cast<std::uint8_t>(value), format));
  } else {
    encode(value, format.order, registers);
  }
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
