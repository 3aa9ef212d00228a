// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace coupler::codec {

/// Where the bytes of a value stand in its registers. A is the most significant byte.
/// Values of one register know ABCD ("AB") and BADC ("BA") only.
enum class Order : std::uint8_t {
  ABCD,  ///< big endian throughout
  CDAB,  ///< registers reversed: the least significant register first
  BADC,  ///< the two bytes of each register swapped
  DCBA,  ///< both: little endian throughout
};

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
  switch (order) {
    case Order::ABCD: return "ABCD";
    case Order::CDAB: return "CDAB";
    case Order::BADC: return "BADC";
    case Order::DCBA: return "DCBA";
  }
  return "?";
}

/// Reads "ABCD", "CDAB", "BADC", "DCBA", "AB" (= ABCD) and "BA" (= BADC); nothing else.
constexpr std::optional<Order> parse_order(std::string_view text) {
  if (text == "ABCD" || text == "AB") return Order::ABCD;
  if (text == "CDAB") return Order::CDAB;
  if (text == "BADC" || text == "BA") return Order::BADC;
  if (text == "DCBA") return Order::DCBA;
  return std::nullopt;
}

}  // namespace coupler::codec
