// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"

namespace coupler::codec {

/// Where the bytes of a value stand in its registers. A is the most significant byte.
/// Values of one register know ABCD ("AB") and BADC ("BA") only.
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
using coupler::to_string;

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

}  // namespace coupler::codec
