// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/table.hpp"

namespace coupler::loader {

/// How addresses are written in the file.
enum class Addressing : std::uint8_t {
  zero_based,  ///< the number is the address in the request, 0 … 65535, decimal or hexadecimal
  /// Modicon numbers count from 1. The number of digits, with leading zeros, decides what they mean:
  ///   1 … 4 digits  the number alone, in any table: 1 is address 0
  ///   5 digits      the table's digit (0 coils, 1 discrete inputs, 3 input registers, 4 holding registers),
  ///   then
  ///                 the number 0001 … 9999: 40001 is address 0
  ///   6 digits      the table's digit, then the number 00001 … 65536: 465536 is address 65535
  /// So a number alone never has five digits: the input register number 10000 is 310000, and 10000 is
  /// invalid.
  modicon,
};
constexpr Enumeration<Addressing, 2> enumeration(Addressing) {
  return {"Addressing", {{Addressing::zero_based, "zero_based"}, {Addressing::modicon, "modicon"}}};
}

struct AddressError {
  std::string what;
  std::string remedy;
};

/// The zero-based address.
tl::expected<std::uint16_t, AddressError> parse_address(std::string_view text, Table table,
                                                        Addressing addressing);

/// Returns the address as parse_address() reads it.
std::string address_text(std::uint16_t address, Table table, Addressing addressing);

/// The zero-based number looks like a Modicon number of this table: 10001 … 19999 for discrete inputs. Those
/// of coils look like any other number.
bool looks_like_modicon(std::uint16_t address, Table table);

}  // namespace coupler::loader
