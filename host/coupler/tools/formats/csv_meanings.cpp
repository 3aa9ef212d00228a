// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_meanings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_units.hpp"
#include "coupler/tools/formats/csv_values.hpp"

namespace coupler::formats {
namespace {

using loader::Problems;
using loader::shown;

/// Empties the cells "-" and "N/A" in the columns of numbers.
void empty_cells_that_say_nothing(const std::vector<Column>& columns, std::vector<Row>& rows) {
  constexpr std::string_view of_numbers[] = {
      "address", "bit",      "count",        "length",     "scale",      "exponent",       "offset",
      "min",     "max",      "range",        "order",      "registers",  "address_offset", "unit",
      "raw_low", "raw_high", "scale_offset", "scaled_low", "scaled_high"};
  for (const std::string_view key : of_numbers) {
    const std::size_t i = find_column(columns, key);
    if (i == columns.size()) continue;
    for (auto row = rows.begin() + 1; row != rows.end(); ++row)
      if (i < row->size() && says_nothing((*row)[i].text)) (*row)[i].text.clear();
  }
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
    bool has_words = has_line;
    bool has_numbers = false;
    for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
      const std::string_view text = text_at(*row, i);
      const std::string word = letters_and_digits(text);
      const bool is_word = word == "linear" || word == "squareroot";
      has_words = has_words || is_word;
      has_numbers = has_numbers || (has_line ? decimal(text).has_value() : !text.empty() && !is_word);
    }
    if (!has_words || has_numbers) continue;
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

/// Which readings of a gain its numbers, and the ranges and units beside them, leave over: "0 to 6553.5" is
/// no multiple of 10, but of 0.1.
struct Possible {
  bool factor = true;
  bool divisor = true;
  bool exponent = true;        ///< whole numbers
  bool only_exponent = false;  ///< -1 and 0 are hardly anything else
};

void judge_by_units(double gain, std::string_view text, Possible& possible) {
  const auto units = read_scaled_units(text);
  if (!units || units->is_times) return;
  const double factor = loader::parse_number(units->factor).value_or(1);
  const bool is_factor = std::abs(gain / factor - 1) < 1e-6;
  const bool is_divisor = std::abs(gain * factor - 1) < 1e-6;
  if (is_factor == is_divisor) return;
  possible.factor = possible.factor && is_factor;
  possible.divisor = possible.divisor && is_divisor;
}

void judge_by_range(const Row& row, const std::vector<Column>& columns, double gain, Possible& possible) {
  const auto type = codec::parse_type(text_at(row, find_column(columns, "type")));
  const auto ends = read_range(text_at(row, find_column(columns, "range")));
  const bool counts =
      type && codec::is_scalable(*type) && *type != codec::Type::REAL && *type != codec::Type::LREAL;
  if (!counts || !ends || is_raw_range(*ends, *type)) return;
  if (ends->comma_may_be_of_thousands || ends->point_may_be_of_thousands) return;
  for (const std::string& end : {ends->low, ends->high}) {
    const auto number = loader::parse_number(end);
    if (!number) continue;
    possible.factor = possible.factor && is_whole(*number / gain);
    possible.divisor = possible.divisor && is_whole(*number * gain);
  }
}

Possible judge(const std::vector<Column>& columns, std::size_t gain_column, const std::vector<Row>& rows) {
  constexpr double most = 10;
  Possible possible;
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
    const auto gain = loader::parse_number(factor_text(text_at(*row, gain_column), Reading::plain));
    if (!gain) continue;
    possible.exponent = possible.exponent && is_whole(*gain) && std::abs(*gain) <= most;
    possible.only_exponent = possible.only_exponent || *gain <= 0;
    if (*gain <= 0 || *gain == 1) continue;
    judge_by_units(*gain, text_at(*row, find_column(columns, "units")), possible);
    judge_by_range(*row, columns, *gain, possible);
  }
  possible.only_exponent = possible.only_exponent && possible.exponent;
  return possible;
}

/// Says how a gain is read, or which ways there are.
void decide_factor(std::vector<Column>& columns, std::size_t i, const std::vector<Row>& rows,
                   Problems& problems) {
  const auto differs = [i](double usual) {
    return [i, usual](const Row& row) {
      return loader::parse_number(factor_text(text_at(row, i), Reading::plain)).value_or(usual) != usual;
    };
  };
  const auto first = std::find_if(rows.begin() + 1, rows.end(), differs(1));
  if (first == rows.end()) return;
  if (std::none_of(rows.begin() + 1, rows.end(), differs(0))) {
    columns[i] = Column{};  // 10^0: no row is scaled
    return;
  }
  const Possible possible = judge(columns, i, rows);
  const Cell& heading = rows.front()[i];
  if (possible.only_exponent) {
    problems.error(
        heading.at,
        fmt::format("{} has three meanings: with {}, a register is multiplied by it, or divided, or it is "
                    "an exponent: a register x 10^{}",
                    shown(heading.text), shown((*first)[i].text), (*first)[i].text),
        fmt::format("write --columns 'exponent={0}' if it is an exponent of ten, --columns 'scale={0}' if it "
                    "is a factor, or --columns 'divisor={0}'",
                    for_columns(heading.text)));
  } else if (possible.factor != possible.divisor) {
    columns[i].reading = possible.factor ? Reading::plain : Reading::divisor;
    problems.warning(heading.at,
                     fmt::format("{} is read as a {}, for the ranges and units in the table fit only that",
                                 shown(heading.text), possible.factor ? "factor" : "divisor"),
                     fmt::format("if that is wrong, write --columns '{}={}'",
                                 possible.factor ? "divisor" : "scale", for_columns(heading.text)));
  } else {
    problems.error(
        heading.at,
        fmt::format("{} has two meanings: with {}, some makers multiply a register by it, others divide",
                    shown(heading.text), shown((*first)[i].text)),
        fmt::format("write --columns 'scale={0}' if it is a factor, or --columns 'divisor={0}'; the ranges "
                    "and units in the table show which",
                    for_columns(heading.text)));
  }
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
      fmt::format("{} has several meanings: {} may be added to the scaled value, behind the factor; to the "
                  "register, before the factor; or to the address",
                  shown(heading.text), shown((*differs)[i].text)),
      fmt::format("write --columns 'scale_offset={0}', --columns 'raw_offset={0}' or --columns "
                  "'address_offset={0}'",
                  for_columns(heading.text)));
}

/// An offset of the address may be in the address already.
void decide_address_offset(const std::vector<Column>& columns, const std::vector<Row>& rows,
                           Problems& problems) {
  const std::size_t i = find_column(columns, "address_offset");
  if (i == columns.size() || columns[i].is_chosen) return;
  const auto differs = std::find_if(rows.begin() + 1, rows.end(), [i](const Row& row) {
    return loader::parse_number(text_at(row, i)).value_or(0) != 0;
  });
  if (differs == rows.end()) return;
  const Cell& heading = rows.front()[i];
  problems.error(heading.at,
                 fmt::format("{} has two meanings: {} is to be added to the address, or it is in the address "
                             "already",
                             shown(heading.text), shown((*differs)[i].text)),
                 fmt::format("write --columns 'address_offset={0}' to add it, or --columns 'ignore={0}'",
                             for_columns(heading.text)));
}

}  // namespace

void decide_meanings(std::vector<Column>& columns, std::vector<Row>& rows, Problems& problems) {
  empty_cells_that_say_nothing(columns, rows);
  tell_units_from_unit_ids(columns, rows);
  tell_scaling_from_factors(columns, rows);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].reading == Reading::factor_or_divisor) decide_factor(columns, i, rows, problems);
  decide_offset(columns, rows, problems);
  decide_address_offset(columns, rows, problems);
  decide_count(columns, rows, problems);
  decide_length(columns, rows, problems);
  keep_exported_units(columns, rows.front());
}

}  // namespace coupler::formats
