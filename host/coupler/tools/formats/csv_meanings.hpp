// SPDX-License-Identifier: Apache-2.0
// Columns whose heading has two meanings: what their cells, or other columns, say of it.
#pragma once

#include <vector>

#include "coupler/map/loader/problems.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_header.hpp"

namespace coupler::formats {

/// Decides what the cells decide. What they do not is an error that names both meanings, and the option that
/// chooses.
void decide_meanings(std::vector<Column>& columns, std::vector<Row>& rows, loader::Problems& problems);

// Parts of it that types and addresses decide.

/// "Count" is the number of values of an array, or of registers.
void decide_count(std::vector<Column>& columns, const std::vector<Row>& rows, loader::Problems& problems);

/// "Length" is that of a text in bytes, or of any type in registers.
void decide_length(std::vector<Column>& columns, const std::vector<Row>& rows, loader::Problems& problems);

}  // namespace coupler::formats
