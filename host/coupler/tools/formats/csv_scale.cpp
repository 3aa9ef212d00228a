// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/csv_values.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

bool may_be_scaled(const RowPoint& point) {
  return !holds_bits(point.table) && (!point.type.type || codec::is_scalable(*point.type.type));
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
  return row.at("scaling") == nullptr && row.cell("raw_low") != nullptr && row.cell("raw_high") != nullptr &&
         row.cell("scaled_low") != nullptr && row.cell("scaled_high") != nullptr;
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

/// What is told of units that hold a factor, and the ways to read them.
void ask_for_units(const RowView& row, const Cell& cell, const FactorAndUnits& units) {
  const std::string heading = row.header[static_cast<std::size_t>(&cell - row.row.data())].text;
  if (units.is_times)
    row.problems.error(
        cell.at,
        fmt::format("the units {} have two meanings: a register is multiplied by {}, or divided",
                    shown(cell.text), units.factor),
        fmt::format("write --columns 'scaled_units={0}' for the first, --columns 'divided_units={0}' for the "
                    "second, or --columns 'units={0}' to take the text as it is",
                    heading));
  else
    row.problems.error(
        cell.at,
        fmt::format("the units {} have two meanings: a register x {} is in '{}', or the value stays as it is "
                    "in the register",
                    shown(cell.text), units.factor, units.units),
        fmt::format("write --columns 'scaled_units={0}' for the first, or --columns 'units={0}' for the "
                    "second, which takes the text as it is",
                    heading));
}

bool is_near(double a, double b) { return std::abs(a - b) <= std::abs(b) * 1e-9; }

/// "0.1V": where a scale says the same, the rest is the unit.
void split_units(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("units");
  Entry* entry = find(point.entry, "units");
  if (cell == nullptr || entry == nullptr || !may_be_scaled(point)) return;
  const Column& column = row.columns[static_cast<std::size_t>(cell - row.row.data())];
  const auto units = read_scaled_units(entry->text);
  if (!units || (column.is_chosen && column.reading == Reading::plain)) return;
  const double factor = loader::parse_number(units->factor).value_or(1);
  Entry* scale = find(point.entry, "scale");
  const auto said = scale != nullptr ? loader::parse_number(scale->text) : std::nullopt;
  const bool is_scaled = scale != nullptr && said.value_or(0) != 1;
  const bool same = said && (is_near(*said, factor) || (units->is_times && is_near(*said, 1 / factor)));
  if (is_scaled && !same) return;
  if (!is_scaled) {
    if (column.reading != Reading::scaled_units && column.reading != Reading::divided_units) {
      entry->text = units->units;  // or the loader would warn of the same
      return ask_for_units(row, *cell, *units);
    }
    const bool divides = column.reading == Reading::divided_units;
    set(point.entry, scalar("scale", divides ? fmt::format("{}", 1 / factor) : units->factor, cell->at));
    entry = find(point.entry, "units");
  }
  entry->text = units->units;
}

void add_scale_offset(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("scale_offset");
  if (cell == nullptr) return;
  const auto offset = decimal(cell->text);
  const Entry* scale = loader::child(point.entry, "scale");
  if (!offset || (scale != nullptr && scale->kind != Entry::Kind::scalar)) {
    row.problems.error(
        cell->at,
        offset ? "the scale has an offset of its own" : fmt::format("{} is not a number", shown(cell->text)),
        "write the number that is added to the scaled value, or nothing");
    return;
  }
  if (loader::parse_number(*offset) == 0.0) return;
  Entry both = section("scale", cell->at);
  both.children = {
      scalar("gain", scale != nullptr ? scale->text : "1", scale != nullptr ? scale->at : cell->at),
      scalar("offset", *offset, cell->at)};
  set(point.entry, std::move(both));
}

void add_range(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("range");
  if (cell == nullptr) return;
  const auto ends = read_range(cell->text);
  if (!ends)
    row.problems.error(cell->at, fmt::format("{} is not a range of numbers", shown(cell->text)),
                       "write it as in 0..100, or empty the cell");
  else if (!may_be_scaled(point) && (ends->low != "0" || ends->high != "1"))
    row.problems.warning(
        cell->at, fmt::format("the range {} is not carried over: the type has none", shown(cell->text)),
        "no action is needed if the device refuses other values");
  if (!ends || !may_be_scaled(point)) return;
  for (const auto& [key, text] : {std::pair("min", ends->low), std::pair("max", ends->high)}) {
    const Entry* there = loader::child(point.entry, key);
    if (there == nullptr)
      point.entry.children.push_back(scalar(key, text, cell->at));
    else if (loader::parse_number(there->text) != loader::parse_number(text))
      row.problems.error(
          cell->at, fmt::format("the range {} contradicts '{}: {}'", shown(cell->text), key, there->text),
          "correct one of the two");
  }
}

}  // namespace

void add_scale(const RowView& row, RowPoint& point) {
  add_line(row, point);
  split_units(row, point);
  add_scale_offset(row, point);
  add_range(row, point);
}

}  // namespace coupler::formats
