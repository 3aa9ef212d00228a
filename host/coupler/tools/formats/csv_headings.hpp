// SPDX-License-Identifier: Apache-2.0
// What people call the columns of a table of points.
#pragma once

#include <string>
#include <string_view>

namespace coupler::formats {

/// How the cells below a heading are read.
enum class Reading {
  plain,                ///< as the map's key is
  function_codes,       ///< numbers are those, and name a table
  divisor,              ///< value = register / cell
  exponent,             ///< value = register x 10^cell
  factor_or_divisor,    ///< makers' tables have both under this heading
  may_be_written,       ///< yes or no, or a tick
  may_not_be_written,   ///< the same
  range,                ///< "0..100": `min` and `max`
  registers,            ///< how many the value has
  values_or_registers,  ///< "Count": of an array, or that of the registers
  bytes_or_registers,   ///< "Length"
  bytes,                ///< of a text; says nothing of other types
  address_offset,       ///< is added to the address
  scale_offset,         ///< is added to the scaled value
  raw_offset,           ///< is added to the register, before the factor
  scaled_units,         ///< "0.1V": register x 0.1, in V
  divided_units,        ///< "V*10": register / 10, in V
  scaling,              ///< "Linear", "None": of the four below
  raw_low,
  raw_high,
  scaled_low,
  scaled_high,
  negate,    ///< 1: the scaled value with the other sign
  left_out,  ///< concerns the other program only
};

/// The column that a heading means: "Data Type" is `type`, "Tag" is `name`.
struct Meaning {
  std::string key;  ///< the heading in lower case, with '_' for blanks, if it is none of the known words
  Reading reading = Reading::plain;
};
Meaning meaning_of(std::string_view heading);

/// The columns that every table of `coupler export` begins with.
constexpr std::string_view exported_columns[] = {"table", "name",   "address", "type",
                                                 "order", "access", "units",   "description"};

/// The heading in one line with single blanks: "Scale factor", however the file breaks it.
std::string in_one_line(std::string_view heading);

/// As --columns takes it: in one line, and in quotes if it has a comma.
std::string for_columns(std::string_view heading);

/// "R/W" -> "rw", "Data type" -> "datatype"
std::string letters_and_digits(std::string_view text);

}  // namespace coupler::formats
