// SPDX-License-Identifier: Apache-2.0
// What stands in the column of addresses besides a number: the table, a bit, the length of a text or of an
// array. "400020.03", "400030.20H" and "400060 [8]" are those of OPC servers (Kepware).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv_type.hpp"

namespace coupler::formats {

struct AddressCell {
  std::string text;  ///< the address alone, as the map's `addressing` says
  std::optional<Table> table;
  std::optional<std::uint64_t> bit;
  std::optional<std::uint64_t> length;     ///< of a STRING, in bytes
  bool high_byte_first = false;            ///< of a STRING that has a length here
  std::optional<std::uint64_t> count;      ///< of an array
  std::optional<std::uint64_t> registers;  ///< or bits, of "40001-40002"

  std::string what;  ///< not empty: why the cell is no address
  std::string remedy;
};

/// `type` decides whether what follows a point is a bit or a length.
AddressCell read_address_cell(std::string_view text, const TypeCell& type, loader::Addressing addressing);

}  // namespace coupler::formats
