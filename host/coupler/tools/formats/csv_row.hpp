// SPDX-License-Identifier: Apache-2.0
// A row of a table of points, and the parts of a point that several of its cells make together.
#pragma once

#include <string_view>
#include <vector>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_address.hpp"
#include "coupler/tools/formats/csv_header.hpp"
#include "coupler/tools/formats/csv_type.hpp"
#include "coupler/tools/formats/importers.hpp"

namespace coupler::formats {

struct RowView {
  const Row& header;
  const std::vector<Column>& columns;
  const Row& row;
  const ImportOptions& options;
  loader::Problems& problems;

  /// The cell, empty or not; nullptr if there is no such column, or the row ends before.
  const Cell* at(std::string_view key) const;
  /// The same, or nullptr if it is empty.
  const Cell* cell(std::string_view key) const;
};

/// What a row says of its point.
struct RowPoint {
  TypeCell type;
  AddressCell address;
  Table table = Table::coils;
  loader::Entry entry;
};

/// The points of all rows behind the first, by their unit ids.
std::vector<ForeignUnit> read_rows(const std::vector<Column>& columns, const ImportOptions& options,
                                   const std::vector<Row>& rows, loader::Problems& problems);

/// `bit`, `count` and `length`, from the cells of the type, the address and the number of registers.
void add_size(const RowView& row, RowPoint& point);

/// `scale`, `units`, `min` and `max`, from all cells that a scale may stand in.
void add_scale(const RowView& row, RowPoint& point);

}  // namespace coupler::formats
