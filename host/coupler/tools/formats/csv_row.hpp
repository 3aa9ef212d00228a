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
#include "coupler/tools/formats/csv_questions.hpp"
#include "coupler/tools/formats/csv_type.hpp"
#include "coupler/tools/formats/importers.hpp"

namespace coupler::formats {

class RowView {
 public:
  const Row& header;
  const std::vector<Column>& columns;
  const Row& row;
  const ImportOptions& options;
  char separator;  ///< of the file's cells
  Questions& questions;
  loader::Problems& problems;

  /// The cell, empty or not; nullptr if there is no such column, or the row ends before.
  const Cell* at(std::string_view key) const;
  /// The same, or nullptr if it is empty.
  const Cell* cell(std::string_view key) const;

  const Column& column_of(const Cell& of_row) const { return columns[index_of(of_row)]; }
  /// As --columns takes it.
  std::string heading_of(const Cell& of_row) const { return for_columns(header[index_of(of_row)].text); }

 private:
  std::size_t index_of(const Cell& of_row) const { return static_cast<std::size_t>(&of_row - row.data()); }
};

/// What a row says of its point.
struct RowPoint {
  TypeCell type;
  AddressCell address;
  Table table = Table::coils;
  loader::Entry entry;

  /// The type is a number, or the loader says that there is none.
  bool is_number() const;
};

/// The points of all rows behind the first, by their unit ids.
std::vector<ForeignUnit> read_rows(const std::vector<Column>& columns, const ImportOptions& options,
                                   const std::vector<Row>& rows, char separator, loader::Problems& problems);

/// `bit`, `count` and `length`, from the cells of the type, the address and the number of registers.
void add_size(const RowView& row, RowPoint& point);

/// `order` of several registers; asks for it if nothing says it.
void add_order(const RowView& row, RowPoint& point);

/// `scale` and `units`, from all cells that a scale may stand in.
void add_scale(const RowView& row, RowPoint& point);

/// An error if the cell is a number such as "1,000", or in a file with decimal commas "1.000": it may be one
/// of thousands, or have three decimals.
bool refuse_thousands(const RowView& row, const Cell& cell);

/// `min` and `max` of "0..100".
void add_range(const RowView& row, RowPoint& point);

}  // namespace coupler::formats
