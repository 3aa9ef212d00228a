// SPDX-License-Identifier: Apache-2.0
// What stands in the column of types besides the type: "string[6]", "Short Array", "UINT16[8]", "Float CDAB".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/codec/format.hpp"

namespace coupler::formats {

struct TypeCell {
  std::string text;                     ///< the type alone, or the whole cell if it is no such type
  std::optional<codec::Type> type;      ///< nullopt: the loader says why
  std::string order;                    ///< "CDAB", or empty
  bool is_array = false;                ///< the cell says so
  std::optional<std::uint64_t> count;   ///< of the array
  std::optional<std::uint64_t> number;  ///< 6 of "string[6]": characters or registers
};

TypeCell read_type_cell(std::string_view text);

}  // namespace coupler::formats
