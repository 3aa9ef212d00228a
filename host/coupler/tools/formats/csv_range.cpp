// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/csv_values.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

/// The two numbers; nullopt, with the reason told, if the cell says nothing of the value that a map can say.
std::optional<Ends> ends_of(const RowView& row, const RowPoint& point, const Cell& cell) {
  auto ends = read_range(cell.text);
  const auto leave_out = [&](const char* why, const char* remedy) {
    row.problems.warning(cell.at, fmt::format("the range {} is not carried over: {}", shown(cell.text), why),
                         remedy);
    return std::nullopt;
  };
  if (!ends)
    return leave_out("it is not two numbers",
                     "write it as in 0..100, or as in 0=off;1=on where a number has names for its values, "
                     "each once");
  const bool is_open =
      ends->comma_may_be_of_thousands || (row.separator == ';' && ends->point_may_be_of_thousands);
  if (is_open) {
    row.problems.error(cell.at,
                       fmt::format("a number of the range {} has two readings: three digits behind a sign "
                                   "are thousands, or decimals",
                                   shown(cell.text)),
                       fmt::format("write thousands without the sign, and decimals as in 1.5 or 1.50; or "
                                   "leave the column out with --columns 'ignore={}'",
                                   row.heading_of(cell)));
    return std::nullopt;
  }
  if (point.type.type && is_raw_range(*ends, *point.type.type)) return std::nullopt;
  if (point.is_number()) return ends;
  if (ends->low == "0" && ends->high == "1") return std::nullopt;
  return leave_out("the type has none", "no action is needed if the device refuses other values");
}

/// "0=Off;1=On" becomes the names of the values, where the point can have these.
bool add_names(const Cell& cell, RowPoint& point) {
  const bool is_whole = point.is_number() && point.type.type && !codec::is_float(*point.type.type);
  const Entry* scale = loader::child(point.entry, "scale");
  const bool is_scaled = scale != nullptr && loader::parse_number(scale->text) != 1.0;
  if (!is_whole || is_scaled || loader::child(point.entry, "values") != nullptr) return false;
  const auto names = read_names(cell.text, *point.type.type);
  if (names.empty()) return false;
  Entry values = section("values", cell.at);
  for (const auto& [number, name] : names) values.children.push_back(scalar(number, name, cell.at));
  set(point.entry, std::move(values));
  return true;
}

}  // namespace

bool refuse_thousands(const RowView& row, const Cell& cell) {
  const char sign = sign_of_thousands(cell.text);
  const bool is_open = row.separator == ';' ? sign == '.' : sign == ',';
  if (!is_open || !decimal(cell.text)) return false;
  const std::size_t at = cell.text.find(sign);
  const std::string before = cell.text.substr(0, at);
  const std::string behind = cell.text.substr(at + 1);
  row.problems.error(cell.at,
                     fmt::format("{} has two readings: {}{}, with a sign between the thousands, or {}.{}",
                                 shown(cell.text), before, behind, before, behind),
                     fmt::format("write {}{}, or {}.{}0", before, behind, before, behind));
  return true;
}

void add_range(const RowView& row, RowPoint& point) {
  const Cell* cell = row.cell("range");
  if (cell == nullptr || add_names(*cell, point)) return;
  const auto ends = ends_of(row, point, *cell);
  if (!ends) return;
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

}  // namespace coupler::formats
