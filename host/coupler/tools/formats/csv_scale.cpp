// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/csv_scan.hpp"
#include "coupler/tools/formats/csv_units.hpp"
#include "coupler/tools/formats/csv_values.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

/// The number without a sign that a scaled word is; nullopt if the type is none of them.
std::optional<codec::Type> number_of_word(codec::Type type) {
  switch (type) {
    case codec::Type::BYTE: return codec::Type::USINT;
    case codec::Type::WORD: return codec::Type::UINT;
    case codec::Type::DWORD: return codec::Type::UDINT;
    case codec::Type::LWORD: return codec::Type::ULINT;
    default: return std::nullopt;
  }
}

bool may_be_scaled(const RowPoint& point) {
  const bool is_word = !holds_bits(point.table) && point.type.type && number_of_word(*point.type.type);
  return point.is_number() || is_word;
}

/// The column beside that of the factor.
void add_exponent(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("exponent");
  if (cell == nullptr) return;
  const auto power = loader::parse_number(factor_text(cell->text, Reading::exponent));
  const Entry* scale = loader::child(point.entry, "scale");
  const auto factor = scale != nullptr ? loader::parse_number(scale->text) : 1.0;
  if (!power)
    row.problems.error(cell->at, fmt::format("{} is not an exponent of ten", shown(cell->text)),
                       "write a whole number from -30 to 30, or nothing");
  else if (factor)  // the loader reports that the other is none
    set(point.entry, scalar("scale", fmt::format("{:.15g}", *factor * *power), cell->at));
}

/// A factor of 1 beside a text, a bit or a word says that there is none.
void drop_factor_of_1(RowPoint& point) {
  const Entry* scale = loader::child(point.entry, "scale");
  if (scale != nullptr && !point.is_number() && loader::parse_number(scale->text) == 1.0)
    drop(point.entry, "scale");
}

/// A cell like "x10" has a factor and no units.
void drop_empty_units(RowPoint& point) {
  const Entry* units = loader::child(point.entry, "units");
  if (units != nullptr && units->text.empty()) drop(point.entry, "units");
}

void make_scaled_word_a_number(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("type");
  Entry* type = find(point.entry, "type");
  if (cell == nullptr || type == nullptr || holds_bits(point.table) || !point.type.type) return;
  const auto number = number_of_word(*point.type.type);
  if (!number || loader::child(point.entry, "scale") == nullptr) return;
  point.type.type = number;
  type->text = to_string(*number);
  row.problems.warning(
      cell->at, fmt::format("{} is scaled, so the point is {}, a number", shown(cell->text), type->text),
      fmt::format("write the type {} if it has a sign", type->text.substr(1)));
}

bool is_yes(const Cell* cell) {
  return cell != nullptr && (cell->text == "1" || loader::parse_boolean(cell->text).value_or(false));
}

/// "Linear" of an OPC server, or four numbers alone.
bool is_line(const RowView& row) {
  const Cell* kind = row.cell("scaling");
  if (kind != nullptr) {
    const std::string word = letters_and_digits(kind->text);
    if (word == "linear") return true;
    if (word == "squareroot")
      row.problems.error(
          kind->at, fmt::format("{} is no straight line, and a map has no other scale", shown(kind->text)),
          "empty the cell, and take the root in your program");
    else if (word != "none")
      row.problems.error(kind->at, fmt::format("{} is not a scaling", shown(kind->text)),
                         "write Linear or None");
    return false;
  }
  if (row.at("scaling") != nullptr) return false;
  const Cell* some = nullptr;
  bool has_all = true;
  for (const std::string_view key : {"raw_low", "raw_high", "scaled_low", "scaled_high"}) {
    const Cell* cell = row.cell(key);
    if (cell != nullptr) some = cell;
    has_all = has_all && cell != nullptr;
  }
  if (some != nullptr && !has_all)
    row.problems.warning(some->at, "the value is not scaled, for only some of the four numbers are there",
                         "write Raw Low, Raw High, Scaled Low and Scaled High, or empty them");
  return has_all;
}

Entry pair_of(std::string_view key, const Entry& first, const Entry& second) {
  Entry entry = section(key, first.at);
  entry.kind = Entry::Kind::list;
  entry.children = {first, second};
  return entry;
}

/// A number of the line; without text if the cell is none, which is reported.
Entry end_of_line(const RowView& row, std::string_view key) {
  const Cell* cell = row.at(key);
  const Cell& place = cell != nullptr                  ? *cell
                      : row.cell("scaling") != nullptr ? *row.cell("scaling")
                                                       : row.row.front();
  const auto number = cell != nullptr ? decimal(cell->text) : std::nullopt;
  if (number) refuse_thousands(row, place);
  if (!number)
    row.problems.error(
        place.at,
        cell == nullptr || cell->text.empty()
            ? fmt::format("a linear scaling has no '{}'", key)
            : fmt::format("{} is not a number, and a linear scaling needs it", shown(cell->text)),
        "write numbers for Raw Low, Raw High, Scaled Low and Scaled High");
  return scalar("", number.value_or(""), place.at);
}

void change_sign(Entry& number) {
  number.text = number.text.substr(0, 1) == "-" ? number.text.substr(1) : "-" + number.text;
}

void add_line(const RowView& row, RowPoint& point) {
  const Cell* negative = row.cell("negate");
  if (!is_line(row)) {
    if (is_yes(negative))
      row.problems.warning(negative->at, "the value is not negated, for it is not scaled",
                           "write 'scale: -1' in the map if it should be");
    return;
  }
  const std::size_t errors = row.problems.errors();
  const Entry raw = pair_of("raw", end_of_line(row, "raw_low"), end_of_line(row, "raw_high"));
  Entry value = pair_of("value", end_of_line(row, "scaled_low"), end_of_line(row, "scaled_high"));
  if (row.problems.errors() > errors) return;
  if (is_yes(negative))
    for (Entry& number : value.children) change_sign(number);
  Entry scale = section("scale", raw.at);
  scale.children = {raw, std::move(value)};
  set(point.entry, std::move(scale));
}

/// Units that hold a factor, and the ways to read them.
void ask_for_units(const RowView& row, const Cell& cell, const FactorAndUnits& units) {
  const std::string heading = row.heading_of(cell);
  if (units.is_times)
    row.questions.ask(
        Question::units_times, cell,
        fmt::format("the units {} have two meanings: a register is multiplied by {}, or divided",
                    shown(cell.text), units.factor),
        fmt::format("write --columns 'scaled_units={0}' for the first, --columns 'divided_units={0}' for the "
                    "second, or --columns 'units={0}' to take the text as it is; units such as 0.1V are a "
                    "register x 0.1 with both of the first two",
                    heading));
  else
    row.questions.ask(
        Question::units, cell,
        fmt::format("the units {} have two meanings: a register x {} is in '{}', or the value stays as it is "
                    "in the register",
                    shown(cell.text), units.factor, units.units),
        fmt::format("write --columns 'scaled_units={0}' for the first, or --columns 'units={0}' for the "
                    "second, which takes the text as it is",
                    heading));
}

bool is_near(double a, double b) { return std::abs(a - b) <= std::abs(b) * 1e-9; }

/// "1V" is V. Another number that is not understood is an error.
void tell_unknown_units(const RowView& row, const Cell& cell, Entry& units) {
  std::string_view rest = cell.text;
  if (!has_number_apart(rest)) return;
  if (take_word(rest, "1")) drop_blanks(rest);
  if (!has_number_apart(rest))
    units.text = rest;
  else
    row.problems.error(cell.at, fmt::format("the number in the units {} is not understood", shown(cell.text)),
                       "write the units as in 0.1V, or alone, and the factor in a column 'factor'");
}

/// "0.1V": where a scale says the same, the rest is the unit.
void split_units(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("units");
  Entry* entry = find(point.entry, "units");
  if (cell == nullptr || entry == nullptr || !may_be_scaled(point)) return;
  const Column& column = row.column_of(*cell);
  const bool is_told = column.reading == Reading::scaled_units || column.reading == Reading::divided_units;
  if (column.is_chosen && !is_told) return;
  const auto units = read_scaled_units(entry->text);
  if (!units) {
    if (is_told) tell_unknown_units(row, *cell, *entry);
    return;
  }
  const double factor = loader::parse_number(units->factor).value_or(1);
  Entry* scale = find(point.entry, "scale");
  const auto said = scale != nullptr ? loader::parse_number(scale->text) : std::nullopt;
  entry->text = units->units;  // or the loader would warn of the same
  if (scale != nullptr && said.value_or(0) != 1) {
    const bool same = said && (is_near(*said, factor) || (units->is_times && is_near(*said, 1 / factor)));
    if (said && !same)
      row.problems.error(
          cell->at,
          fmt::format("the units {} and the scale {} contradict each other", shown(cell->text), scale->text),
          fmt::format("correct one of the two, or write --columns 'units={}' to take the units "
                      "as they are",
                      row.heading_of(*cell)));
    return;
  }
  if (!is_told) return ask_for_units(row, *cell, *units);
  const bool divides = column.reading == Reading::divided_units && units->is_times;
  set(point.entry, scalar("scale", divides ? fmt::format("{}", 1 / factor) : units->factor, cell->at));
}

void add_scale_offset(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("scale_offset");
  if (cell == nullptr || refuse_thousands(row, *cell)) return;
  const auto offset = decimal(cell->text);
  const Entry* scale = loader::child(point.entry, "scale");
  if (!offset || (scale != nullptr && scale->kind != Entry::Kind::scalar)) {
    row.problems.error(
        cell->at,
        offset ? "the scale has an offset of its own" : fmt::format("{} is not a number", shown(cell->text)),
        "write the number that is added to the scaled value, or nothing");
    return;
  }
  const double number = loader::parse_number(*offset).value_or(0);
  if (number == 0) return;
  const Column& column = row.column_of(*cell);
  const double gain = scale != nullptr ? loader::parse_number(scale->text).value_or(1) : 1;
  const bool is_raw = column.reading == Reading::raw_offset;
  Entry both = section("scale", cell->at);
  both.children = {
      scalar("gain", scale != nullptr ? scale->text : "1", scale != nullptr ? scale->at : cell->at),
      scalar("offset", is_raw ? fmt::format("{}", number * gain) : *offset, cell->at)};
  set(point.entry, std::move(both));
}

}  // namespace

bool RowPoint::is_number() const {
  if (holds_bits(table)) return false;
  return type.type ? codec::is_scalable(*type.type) : !address.bit;
}

void add_scale(const RowView& row, RowPoint& point) {
  add_exponent(row, point);
  drop_factor_of_1(point);
  add_line(row, point);
  split_units(row, point);
  drop_empty_units(point);
  add_scale_offset(row, point);
  make_scaled_word_a_number(row, point);
}

}  // namespace coupler::formats
