// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_header.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/tools/formats/csv_words.hpp"

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

/// The heading's own meaning, or what --columns says of it.
Meaning meaning_of(std::string_view heading, const ImportOptions& options) {
  Meaning own = formats::meaning_of(heading);
  for (const auto& [column, given] : options.columns) {
    if (lower(given) != lower(heading)) continue;
    Meaning meaning = formats::meaning_of(column);
    const bool says_less = meaning.reading == Reading::plain && own.reading != Reading::factor_or_divisor;
    return meaning.key == own.key && says_less ? own : meaning;
  }
  return own;
}

bool is_known(const Column& column) {
  return column.described != nullptr || column.key == "table" || column.key == "name" || column.key == "unit";
}

/// Reports how a column is treated that is not a property of a point.
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
    auto [key, reading] = meaning_of(cell.text, options);
    Column column{std::move(key), nullptr, reading};
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
  if (is_text) *unit = {"units", loader::find_key("units", any_point), Reading::plain};
}

void refuse_two_meanings(const std::vector<Column>& columns, const std::vector<Row>& rows,
                         Problems& problems) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].reading != Reading::factor_or_divisor) continue;
    const auto differs = std::find_if(rows.begin() + 1, rows.end(), [i](const Row& row) {
      if (i >= row.size()) return false;
      std::string number = row[i].text;
      std::replace(number.begin(), number.end(), ',', '.');
      const double factor = loader::parse_number(number).value_or(1);
      return factor != 1 && factor != 0;
    });
    if (differs == rows.end()) continue;
    const Cell& heading = rows.front()[i];
    problems.error(
        heading.at,
        fmt::format("{} has two meanings: with {}, some makers multiply a register by it, others divide",
                    shown(heading.text), shown((*differs)[i].text)),
        fmt::format("write --columns 'scale={0}' if it is a factor, or --columns 'divisor={0}'; the ranges "
                    "and units in the table show which",
                    heading.text));
  }
}

}  // namespace coupler::formats
