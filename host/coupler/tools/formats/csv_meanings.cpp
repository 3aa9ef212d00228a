// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_meanings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_values.hpp"

namespace coupler::formats {
namespace {

using loader::Problems;
using loader::shown;

std::string_view text_at(const Row& row, std::size_t column) {
  return column < row.size() ? std::string_view(row[column].text) : std::string_view{};
}

std::size_t find_column(const std::vector<Column>& columns, std::string_view key) {
  return static_cast<std::size_t>(
      std::find_if(columns.begin(), columns.end(), [key](const Column& c) { return c.key == key; }) -
      columns.begin());
}

/// "Unit" is the unit id to one, "bar" to another: where one cell is no unit id, the column is `units`.
void tell_units_from_unit_ids(std::vector<Column>& columns, const std::vector<Row>& rows) {
  const std::size_t unit = find_column(columns, "unit");
  if (unit == columns.size() || find_column(columns, "units") != columns.size()) return;
  const bool is_text = std::any_of(rows.begin() + 1, rows.end(), [unit](const Row& row) {
    const std::string_view text = text_at(row, unit);
    return !text.empty() && !loader::parse_unsigned(text);
  });
  if (is_text) {
    columns[unit].key = "units";
    columns[unit].described = loader::find_key("units", loader::Section::input_register);
  }
}

/// "Scaling" holds numbers to one, and "Linear" or "None" to an OPC server (Kepware), which has the two
/// points of the line in columns of their own.
void tell_scaling_from_factors(std::vector<Column>& columns, const std::vector<Row>& rows) {
  const bool has_line = find_column(columns, "raw_low") != columns.size();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].reading != Reading::factor_or_divisor) continue;
    const bool has_words = std::any_of(rows.begin() + 1, rows.end(), [i](const Row& row) {
      return !text_at(row, i).empty() && loader::is_letter(text_at(row, i)[0]);
    });
    if (!has_words && !has_line) continue;
    columns[i].key = "scaling";
    columns[i].described = nullptr;
    columns[i].reading = Reading::scaling;
  }
}

/// A table that `coupler export` wrote has the map's own units, whatever they look like.
void keep_exported_units(std::vector<Column>& columns, const Row& header) {
  const bool is_exported =
      header.size() >= std::size(exported_columns) &&
      std::equal(std::begin(exported_columns), std::end(exported_columns), header.begin(),
                 [](const std::string_view column, const Cell& cell) { return column == cell.text; });
  if (is_exported) columns[find_column(columns, "units")].is_chosen = true;
}

bool is_whole(double number) { return std::abs(number - std::round(number)) < 1e-6; }

/// Which of the two readings the ranges leave over: "0 to 6553.5" is no multiple of 10, but of 0.1.
struct Possible {
  bool factor = true;
  bool divisor = true;
};

void judge_by_range(const Row& row, const std::vector<Column>& columns, std::size_t gain_column,
                    Possible& possible) {
  const auto type = codec::parse_type(text_at(row, find_column(columns, "type")));
  const auto gain = loader::parse_number(decimal(text_at(row, gain_column)).value_or(""));
  const auto ends = read_range(text_at(row, find_column(columns, "range")));
  const bool counts =
      type && codec::is_scalable(*type) && *type != codec::Type::REAL && *type != codec::Type::LREAL;
  if (!counts || !gain || *gain <= 0 || *gain == 1 || !ends) return;
  for (const std::string& end : {ends->low, ends->high}) {
    const auto number = loader::parse_number(end);
    if (!number) continue;
    possible.factor = possible.factor && is_whole(*number / *gain);
    possible.divisor = possible.divisor && is_whole(*number * *gain);
  }
}

void decide_factor(std::vector<Column>& columns, std::size_t i, const std::vector<Row>& rows,
                   Problems& problems) {
  const auto differs = std::find_if(rows.begin() + 1, rows.end(), [i](const Row& row) {
    const double factor = loader::parse_number(decimal(text_at(row, i)).value_or("")).value_or(1);
    return factor != 1 && factor != 0;
  });
  if (differs == rows.end()) return;
  Possible possible;
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) judge_by_range(*row, columns, i, possible);
  const Cell& heading = rows.front()[i];
  if (possible.factor != possible.divisor) {
    columns[i].reading = possible.factor ? Reading::plain : Reading::divisor;
    problems.warning(heading.at,
                     fmt::format("{} is read as a {}, for the ranges in the table fit only that",
                                 shown(heading.text), possible.factor ? "factor" : "divisor"),
                     fmt::format("if that is wrong, write --columns '{}={}'",
                                 possible.factor ? "divisor" : "scale", heading.text));
    return;
  }
  problems.error(
      heading.at,
      fmt::format("{} has two meanings: with {}, some makers multiply a register by it, others divide",
                  shown(heading.text), shown((*differs)[i].text)),
      fmt::format("write --columns 'scale={0}' if it is a factor, or --columns 'divisor={0}'; the ranges "
                  "and units in the table show which",
                  heading.text));
}

/// A map's `offset` is `high` or `low`. A number under it is added to the value, or to the address.
void decide_offset(std::vector<Column>& columns, const std::vector<Row>& rows, Problems& problems) {
  const std::size_t i = find_column(columns, "offset");
  if (i == columns.size() || columns[i].is_chosen) return;
  const auto number_in = [i](const Row& row) {
    return loader::parse_number(decimal(text_at(row, i)).value_or("")).value_or(0);
  };
  const auto has_number = [i](const Row& row) { return decimal(text_at(row, i)).has_value(); };
  if (std::none_of(rows.begin() + 1, rows.end(), has_number)) return;
  const auto differs =
      std::find_if(rows.begin() + 1, rows.end(), [&](const Row& row) { return number_in(row) != 0; });
  const Cell& heading = rows.front()[i];
  if (differs == rows.end()) {
    columns[i] = Column{};  // 0 is added, to whatever it is
    return;
  }
  problems.error(
      heading.at,
      fmt::format("{} has two meanings: {} may be added to the scaled value, or to the address",
                  shown(heading.text), shown((*differs)[i].text)),
      fmt::format("write --columns 'scale_offset={0}' or --columns 'address_offset={0}'", heading.text));
}

}  // namespace

void decide_meanings(std::vector<Column>& columns, const std::vector<Row>& rows, Problems& problems) {
  tell_units_from_unit_ids(columns, rows);
  tell_scaling_from_factors(columns, rows);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].reading == Reading::factor_or_divisor) decide_factor(columns, i, rows, problems);
  decide_offset(columns, rows, problems);
  keep_exported_units(columns, rows.front());
}

}  // namespace coupler::formats
