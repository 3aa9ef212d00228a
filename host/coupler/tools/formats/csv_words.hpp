// SPDX-License-Identifier: Apache-2.0
// The words that people write into a table of points for tables, and for what may be written.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv_headings.hpp"

namespace coupler::formats {

/// The meaning of the function codes in a cell; `none` if it has none.
enum class Codes { none, read, write, read_and_write };

/// The table that a cell names, or why it names none.
struct TableWord {
  std::optional<Table> table;
  Codes codes = Codes::none;
  std::string what;
  std::string remedy;
};

/// What the type of a row needs: "input" is input_registers for a number.
enum class Holds { anything, registers };

/// "holding_registers", "Holding Register", "HR", "4x", "FC3", "FC 03/16". In a column of function codes
/// numbers alone are such, elsewhere they have two meanings.
TableWord read_table(std::string_view text, bool function_codes, Holds holds = Holds::anything);

/// The table that a Modicon address of five or six digits begins with: "40001".
std::optional<Table> table_of_modicon(std::string_view address);

/// Returns the word for `access`: "read" for "RO", "read_write" for "R/W" or for "yes" below
/// `may_be_written`, and the text itself if the word is not known.
std::string_view access_of(std::string_view text, Reading reading);

}  // namespace coupler::formats
