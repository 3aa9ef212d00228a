// SPDX-License-Identifier: Apache-2.0
// Tables as spreadsheets and databases write them (RFC 4180). The separator may be ';', ',' or tab; lines end
// with CR LF or LF.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {

struct Cell {
  std::string text;  ///< without quotes, and without blanks around it if there were none
  loader::Position at;
};
using Row = std::vector<Cell>;

/// The one that the first line has most often, outside quotes.
char separator_of(std::string_view text);

/// Empty if the row ends before.
std::string_view text_at(const Row& row, std::size_t column);

/// All rows that are not empty; empty with the first error in `problems` if a quote is never closed, or text
/// follows a closed one.
std::vector<Row> parse_csv(std::string_view text, loader::Problems& problems);

/// The cells below this key are text, whatever they look like; `is_string`: those of a STRING.
bool is_text(const loader::Key& key, bool is_string);

/// Text that spreadsheets do not run: with an apostrophe before it if they would, and one more where
/// apostrophes stand there. unguarded() takes it away.
std::string guarded(std::string_view text);
std::string_view unguarded(std::string_view text);

}  // namespace coupler::formats
