// SPDX-License-Identifier: Apache-2.0
// The line of headings of a table of points: which key of a point each column is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_headings.hpp"
#include "coupler/tools/formats/importers.hpp"

namespace coupler::formats {

struct Column {
  std::string key;
  const loader::Key* described = nullptr;  ///< nullptr: table, name, unit, and what is no key of a point
  Reading reading = Reading::plain;
  bool is_chosen = false;  ///< by --columns
};

/// The place of the column, or the number of columns if there is none.
std::size_t find_column(const std::vector<Column>& columns, std::string_view key);

/// One for each heading of the first row. What is missing, twice, or not a key of a point is reported.
std::vector<Column> read_header(const std::vector<Row>& rows, const ImportOptions& options,
                                loader::Problems& problems);

}  // namespace coupler::formats
