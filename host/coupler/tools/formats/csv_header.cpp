// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_header.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::formats {
namespace {

using loader::Problems;
using loader::Section;
using loader::shown;

constexpr std::size_t most_columns = 1000;

constexpr Section any_point =
    Section::coil | Section::discrete_input | Section::input_register | Section::holding_register;

std::vector<std::string_view> column_names() {
  auto names = loader::key_names(any_point);
  names.insert(names.end(), {"table", "name", "unit"});
  return names;
}

/// Cells below such a heading are asked for, unless they decide.
bool has_two_meanings(Reading reading) {
  return reading == Reading::factor_or_divisor || reading == Reading::values_or_registers ||
         reading == Reading::bytes_or_registers;
}

bool is_same_heading(std::string_view a, std::string_view b) {
  return lower(in_one_line(a)) == lower(in_one_line(b));
}

/// The heading's own meaning, or what --columns says of it.
Column column_of(std::string_view heading, const ImportOptions& options) {
  Meaning own = meaning_of(heading);
  for (const auto& [column, given] : options.columns) {
    if (!is_same_heading(given, heading)) continue;
    if (column == "ignore") return {"", nullptr, Reading::plain, true};
    Meaning meaning = meaning_of(column);
    const bool says_less = meaning.reading == Reading::plain && !has_two_meanings(own.reading);
    if (meaning.key != own.key || !says_less) own = std::move(meaning);
    return {std::move(own.key), nullptr, own.reading, true};
  }
  return {std::move(own.key), nullptr, own.reading, false};
}

/// "Unit" beside "Slave" is that of the value.
void tell_units_from_slaves(std::vector<Column>& columns, const Row& header) {
  const auto is_unit = [](const Column& column) { return column.key == "unit"; };
  const auto is_units = [](const Column& column) { return column.key == "units"; };
  if (std::count_if(columns.begin(), columns.end(), is_unit) < 2 ||
      std::any_of(columns.begin(), columns.end(), is_units))
    return;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (is_unit(columns[i]) && lower(header[i].text) == "unit" && !columns[i].is_chosen) {
      columns[i].key = "units";
      return;
    }
}

/// "Exponent" beside "Factor" is another factor.
void tell_exponents_from_factors(std::vector<Column>& columns) {
  const bool has_factor = std::any_of(columns.begin(), columns.end(), [](const Column& column) {
    return column.key == "scale" && (column.reading == Reading::plain || column.reading == Reading::divisor);
  });
  for (Column& column : columns)
    if (has_factor && column.reading == Reading::exponent) column.key = "exponent";
}

bool is_known(const Column& column) {
  if (column.reading == Reading::left_out) return false;
  if (column.reading != Reading::plain) return true;
  return column.described != nullptr || column.key == "table" || column.key == "name" || column.key == "unit";
}

std::string_view remedy_for_left_out(std::string_view key) {
  if (key == "scan_rate") return "'rate' in the map says how often a second points are read";
  if (key == "clamp_low" || key == "clamp_high")
    return "values beyond the scale's ends are published as they are; 'min' and 'max' limit what is written";
  return "no action is needed: it concerns the other program only";
}

/// Reports how a column is treated that is not a property of a point.
void report_unknown(const Cell& heading, const Column& column, Problems& problems) {
  const std::string_view key = column.key;
  const auto names = column_names();
  const std::string_view near = nearest(key, names);
  if (column.reading == Reading::left_out)
    problems.warning(heading.at, fmt::format("the column {} is not carried over", shown(heading.text)),
                     std::string(remedy_for_left_out(column.key)));
  else if (!near.empty())
    problems.error(heading.at, fmt::format("a point has no key {}", shown(heading.text)),
                   fmt::format("did you mean '{}'? If not, give the column another heading", near));
  else
    problems.warning(
        heading.at,
        fmt::format("the column {} is not carried over: a point has no such key", shown(heading.text)),
        "see docs/import-export.md for the columns, or name it with --columns");
}

/// Some address begins with a letter, as "HR20" does, which names a table.
bool addresses_name_tables(const std::vector<Row>& rows, const std::vector<Column>& columns) {
  const std::size_t at = find_column(columns, "address");
  return at != columns.size() && std::any_of(rows.begin() + 1, rows.end(), [at](const Row& row) {
           return at < row.size() && !row[at].text.empty() &&
                  (loader::is_letter(row[at].text[0]) || row[at].text[0] == '%');
         });
}

void need_columns(const std::vector<Row>& rows, const std::vector<Column>& columns,
                  const ImportOptions& options, Problems& problems) {
  const Row& header = rows.front();
  for (const std::string_view needed : {"table", "name", "address"}) {
    // Modicon's numbers begin with the table's digit.
    const bool is_table = needed == "table";
    if (is_table && options.addressing == loader::Addressing::modicon) continue;
    if (is_table && addresses_name_tables(rows, columns)) continue;
    if (std::none_of(columns.begin(), columns.end(), [&](const Column& c) { return c.key == needed; }))
      problems.error(header.front().at, fmt::format("there is no column '{}'", needed),
                     fmt::format("begin with a line of headings, such as table,name,address,type; or say "
                                 "which one it is: --columns {}=HEADING{}",
                                 needed,
                                 is_table ? "; addresses such as 40001 need no such column with "
                                            "--addressing modicon"
                                          : ""));
  }
}

}  // namespace

std::size_t find_column(const std::vector<Column>& columns, std::string_view key) {
  return static_cast<std::size_t>(
      std::find_if(columns.begin(), columns.end(), [key](const Column& c) { return c.key == key; }) -
      columns.begin());
}

std::vector<Column> read_header(const std::vector<Row>& rows, const ImportOptions& options,
                                Problems& problems) {
  const Row& header = rows.front();
  std::vector<Column> columns;
  if (header.size() > most_columns) {
    problems.error(header.front().at, fmt::format("the first line has {} headings", header.size()),
                   fmt::format("write at most {}", most_columns));
    return columns;
  }
  columns.reserve(header.size());
  for (const Cell& cell : header) columns.push_back(column_of(cell.text, options));
  tell_units_from_slaves(columns, header);
  tell_exponents_from_factors(columns);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Column& column = columns[i];
    const Cell& cell = header[i];
    column.described = loader::find_key(column.key, any_point);
    const auto here = columns.begin() + static_cast<std::ptrdiff_t>(i);
    const auto other = std::find_if(columns.begin(), here,
                                    [&](const Column& c) { return !c.key.empty() && c.key == column.key; });
    if (other != here) {
      const Cell& first = header[static_cast<std::size_t>(other - columns.begin())];
      problems.error(cell.at,
                     fmt::format("the column '{}' is there twice, here as {}", column.key, shown(cell.text)),
                     is_same_heading(first.text, cell.text)
                         ? "remove one, or give it another heading"
                         : fmt::format("remove one, or leave it out with --columns 'ignore={}'",
                                       for_columns(cell.text)));
    }
    if (!is_known(column) && !column.key.empty()) {
      report_unknown(cell, column, problems);
      column.key.clear();
    }
  }
  need_columns(rows, columns, options, problems);
  for (const auto& [column, heading] : options.columns)
    if (std::none_of(header.begin(), header.end(),
                     [&, &name = heading](const Cell& c) { return is_same_heading(c.text, name); }))
      problems.error(header.front().at, fmt::format("--columns: there is no heading {}", shown(heading)),
                     "write it as the file does");
  return columns;
}

}  // namespace coupler::formats
