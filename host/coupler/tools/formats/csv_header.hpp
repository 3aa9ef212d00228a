// SPDX-License-Identifier: Apache-2.0
// The line of headings of a table of points: which key of a point each column is.
#pragma once

#include <string>
#include <vector>

#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_words.hpp"
#include "coupler/tools/formats/importers.hpp"

namespace coupler::formats {

struct Column {
  std::string key;
  const loader::Key* described = nullptr;  ///< nullptr: table, name, unit
  Reading reading = Reading::plain;
};

/// One for each heading. What is missing, twice, or not a key of a point is reported.
std::vector<Column> read_header(const Row& header, const ImportOptions& options, loader::Problems& problems);

/// "Unit" is the unit id to one, "bar" to another: where one cell is no unit id, the column is `units`.
void tell_units_from_unit_ids(std::vector<Column>& columns, const std::vector<Row>& rows);

/// A column that may hold factors or divisors is an error, unless both come to the same.
void refuse_two_meanings(const std::vector<Column>& columns, const std::vector<Row>& rows,
                         loader::Problems& problems);

}  // namespace coupler::formats
