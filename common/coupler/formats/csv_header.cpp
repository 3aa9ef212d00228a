// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/csv_header.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/formats/csv_words.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::formats {
namespace {

using loader::Problems;
using loader::Section;
using loader::shown;

constexpr Section any_point =
    Section::coil | Section::discrete_input | Section::input_register | Section::holding_register;

std::vector<std::string_view> column_names() {
  auto names = loader::key_names(any_point);
  names.insert(names.end(), {"table", "name", "unit"});
  return names;
}

/// The heading's own column, or what --columns says of it.
std::string column_of(std::string_view heading, const ImportOptions& options) {
  for (const auto& [column, given] : options.columns)
    if (lower(given) == lower(heading)) return column;
  return formats::column_of(heading);
}

bool is_known(const Column& column) {
  return column.described != nullptr || column.key == "table" || column.key == "name" || column.key == "unit";
}

/// What becomes of a column that is none of a point's.
void report_unknown(const Cell& heading, std::string_view key, Problems& problems) {
  const auto names = column_names();
  const std::string_view near = nearest(key, names);
  const bool slip =
      std::any_of(names.begin(), names.end(), [&](const auto name) { return is_slip(key, name); });
  if (slip)
    problems.error(heading.at, fmt::format("a point has no key {}", shown(heading.text)),
                   fmt::format("did you mean '{}'? If not, give the column another heading", near));
  else
    problems.warning(
        heading.at,
        fmt::format("the column {} is not carried over: a point has no such key", shown(heading.text)),
        near.empty() ? "see docs/import-export.md for the columns, or name it with --columns"
                     : fmt::format("did you mean '{}'?", near));
}

void need_columns(const Row& header, const std::vector<Column>& columns, const ImportOptions& options,
                  Problems& problems) {
  for (const std::string_view needed : {"table", "name", "address"}) {
    // Modicon's numbers begin with the table's digit.
    if (needed == "table" && options.addressing == loader::Addressing::modicon) continue;
    if (std::none_of(columns.begin(), columns.end(), [&](const Column& c) { return c.key == needed; }))
      problems.error(header.front().at, fmt::format("there is no column '{}'", needed),
                     fmt::format("begin with a line of headings, such as table,name,address,type; or say "
                                 "which one it is: --columns {}=HEADING",
                                 needed));
  }
}

}  // namespace

std::vector<Column> read_header(const Row& header, const ImportOptions& options, Problems& problems) {
  std::vector<Column> columns;
  for (const Cell& cell : header) {
    Column column{column_of(cell.text, options), nullptr, is_of_function_codes(cell.text)};
    column.described = loader::find_key(column.key, any_point);
    const bool twice = std::any_of(columns.begin(), columns.end(),
                                   [&](const Column& c) { return !c.key.empty() && c.key == column.key; });
    if (twice)
      problems.error(cell.at,
                     fmt::format("the column '{}' is there twice, here as {}", column.key, shown(cell.text)),
                     "remove one, or give it another heading");
    if (!is_known(column) && !column.key.empty()) {
      report_unknown(cell, column.key, problems);
      column.key.clear();
    }
    columns.push_back(std::move(column));
  }
  need_columns(header, columns, options, problems);
  for (const auto& [column, heading] : options.columns)
    if (std::none_of(header.begin(), header.end(),
                     [&, &name = heading](const Cell& c) { return lower(c.text) == lower(name); }))
      problems.error(header.front().at, fmt::format("--columns: there is no heading {}", shown(heading)),
                     "write it as the file does");
  return columns;
}

void tell_units_from_unit_ids(std::vector<Column>& columns, const std::vector<Row>& rows) {
  const auto of = [&](std::string_view key) {
    return std::find_if(columns.begin(), columns.end(), [key](const Column& c) { return c.key == key; });
  };
  const auto unit = of("unit");
  if (unit == columns.end() || of("units") != columns.end()) return;
  const auto at = static_cast<std::size_t>(unit - columns.begin());
  const bool is_text = std::any_of(rows.begin() + 1, rows.end(), [at](const Row& row) {
    return at < row.size() && !row[at].text.empty() && !loader::parse_unsigned(row[at].text);
  });
  if (is_text) *unit = {"units", loader::find_key("units", any_point), false};
}

}  // namespace coupler::formats
