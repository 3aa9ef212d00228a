// SPDX-License-Identifier: Apache-2.0
// What people call the columns of a table of points, and what stands in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/table.hpp"

namespace coupler::formats {

/// How the cells below a heading are read.
enum class Reading {
  plain,               ///< as the map's key is
  function_codes,      ///< numbers are those, and name a table
  divisor,             ///< value = register / cell
  factor_or_divisor,   ///< makers' tables have both under this heading
  may_be_written,      ///< yes or no, or a tick
  may_not_be_written,  ///< the same
};

/// The column that a heading means: "Data Type" is `type`, "Tag" is `name`.
struct Meaning {
  std::string key;  ///< the heading in lower case, with '_' for blanks, if it is none of the known words
  Reading reading = Reading::plain;
};
Meaning meaning_of(std::string_view heading);

/// The meaning of the function codes in a cell; `none` if it has none.
enum class Codes { none, read, write, read_and_write };

/// The table that a cell names, or why it names none.
struct TableWord {
  std::optional<Table> table;
  Codes codes = Codes::none;
  std::string what;
  std::string remedy;
};

/// "holding_registers", "Holding Register", "HR", "4x", "FC3", "FC 03/16". In a column of function codes
/// numbers alone are such, elsewhere they have two meanings.
TableWord read_table(std::string_view text, bool function_codes);

/// The table that a Modicon address of five or six digits begins with: "40001".
std::optional<Table> table_of_modicon(std::string_view address);

/// Returns the word for `access`: "read" for "RO", "read_write" for "R/W" or for "yes" below
/// `may_be_written`, and the text itself if the word is not known.
std::string_view access_of(std::string_view text, Reading reading);

/// The factor that does the same; nullopt if the cell is no number, or 0.
std::optional<double> factor_of(std::string_view divisor);

}  // namespace coupler::formats
