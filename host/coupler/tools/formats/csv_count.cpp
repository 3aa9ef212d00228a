// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_meanings.hpp"
#include "coupler/tools/formats/csv_type.hpp"

namespace coupler::formats {
namespace {

using loader::Problems;
using loader::shown;

struct NumberOfRow {
  const Row* row = nullptr;
  std::uint64_t number = 0;
  std::uint64_t registers = 1;  ///< of one value of the type, unless it is a text
  bool is_text = false;
};

/// Of each row that has a number in the column.
std::vector<NumberOfRow> numbers_in(const std::vector<Column>& columns, std::size_t i,
                                    const std::vector<Row>& rows) {
  const std::size_t type_column = find_column(columns, "type");
  std::vector<NumberOfRow> found;
  found.reserve(rows.size());
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
    const auto number = loader::parse_unsigned(text_at(*row, i));
    if (!number) continue;
    const auto type = read_type_cell(text_at(*row, type_column)).type;
    const bool is_text = type == codec::Type::STRING;
    const std::uint64_t registers = type && !is_text ? std::max(codec::width(*type) / 16, 1U) : 1;
    found.push_back({&*row, *number, registers, is_text});
  }
  return found;
}

void become_registers(Column& column) {
  column.key = "registers";
  column.described = nullptr;
  column.reading = Reading::registers;
}

/// The addresses of each table of each unit.
class Places {
 public:
  Places(const std::vector<Column>& columns, const std::vector<Row>& rows)
      : address_(find_column(columns, "address")),
        table_(find_column(columns, "table")),
        unit_(find_column(columns, "unit")) {
    for (auto row = rows.begin() + 1; row != rows.end(); ++row)
      if (const auto address = loader::parse_unsigned(text_at(*row, address_)))
        addresses_[table_of(*row)].insert(*address);
  }

  /// The number of registers between the row's address and the next one; nullopt if none follows.
  std::optional<std::uint64_t> room_of(const Row& row) const {
    const auto begin = loader::parse_unsigned(text_at(row, address_));
    const auto found = addresses_.find(table_of(row));
    if (!begin || found == addresses_.end()) return std::nullopt;
    const auto next = found->second.upper_bound(*begin);
    if (next == found->second.end()) return std::nullopt;
    return *next - *begin;
  }

 private:
  std::pair<std::string_view, std::string_view> table_of(const Row& row) const {
    return {text_at(row, table_), text_at(row, unit_)};
  }

  std::size_t address_;
  std::size_t table_;
  std::size_t unit_;
  std::map<std::pair<std::string_view, std::string_view>, std::set<std::uint64_t>> addresses_;
};

enum class LengthOf { bytes, registers, unknown };

LengthOf length_by_numbers(const std::vector<NumberOfRow>& numbers) {
  bool are_registers = true;
  bool are_bytes = true;
  for (const NumberOfRow& each : numbers) {
    if (each.is_text) continue;
    are_registers = are_registers && each.number == each.registers;
    are_bytes = are_bytes && each.number == 2 * each.registers;
  }
  if (are_registers == are_bytes) return LengthOf::unknown;
  return are_bytes ? LengthOf::bytes : LengthOf::registers;
}

LengthOf length_by_addresses(const std::vector<NumberOfRow>& numbers, const Places& places) {
  bool fills_registers = false;
  for (const NumberOfRow& each : numbers) {
    if (!each.is_text) continue;
    const auto room = places.room_of(*each.row);
    if (!room) continue;
    if (each.number > *room) return LengthOf::bytes;
    if (each.number < *room) return LengthOf::unknown;
    fills_registers = true;
  }
  return fills_registers ? LengthOf::registers : LengthOf::unknown;
}

}  // namespace

void decide_count(std::vector<Column>& columns, const std::vector<Row>& rows, Problems& problems) {
  const std::size_t i = find_column(columns, "count");
  if (i == columns.size() || columns[i].reading != Reading::values_or_registers) return;
  const auto numbers = numbers_in(columns, i, rows);
  const auto is_of_type = [](const NumberOfRow& each) {
    return each.is_text || each.number == each.registers;
  };
  const auto is_long = [](const NumberOfRow& each) { return each.registers > 1; };
  const auto is_open = [&](const NumberOfRow& each) {
    return each.number > 1 && (each.is_text || is_long(each));
  };
  const auto open = std::find_if(numbers.begin(), numbers.end(), is_open);
  columns[i].reading = Reading::plain;
  if (open == numbers.end()) return;
  if (std::all_of(numbers.begin(), numbers.end(), is_of_type) &&
      std::any_of(numbers.begin(), numbers.end(), is_long))
    return become_registers(columns[i]);
  const Cell& heading = rows.front()[i];
  const char* things = open->is_text ? "bytes" : "values of an array";
  problems.error(heading.at,
                 fmt::format("{} has two meanings: {} beside {} is the number of {}, or of registers",
                             shown(heading.text), open->number,
                             shown(text_at(*open->row, find_column(columns, "type"))), things),
                 fmt::format("write --columns '{1}={0}' for {2}, or --columns 'quantity={0}' for registers",
                             for_columns(heading.text), open->is_text ? "length" : "count", things));
}

void decide_length(std::vector<Column>& columns, const std::vector<Row>& rows, Problems& problems) {
  const std::size_t i = find_column(columns, "length");
  if (i == columns.size() || columns[i].reading != Reading::bytes_or_registers) return;
  columns[i].reading = Reading::bytes;
  if (find_column(columns, "registers") != columns.size()) return;  // those say how long a text is
  const auto numbers = numbers_in(columns, i, rows);
  const auto text =
      std::find_if(numbers.begin(), numbers.end(), [](const NumberOfRow& each) { return each.is_text; });
  LengthOf length = length_by_numbers(numbers);
  if (text == numbers.end()) {
    if (length == LengthOf::registers) become_registers(columns[i]);
    return;
  }
  if (length == LengthOf::unknown) length = length_by_addresses(numbers, Places(columns, rows));
  const Cell& heading = rows.front()[i];
  if (length == LengthOf::unknown) {
    problems.error(heading.at,
                   fmt::format("{} has two meanings: {} is the number of bytes of a text, or of registers, "
                               "which hold {}",
                               shown(heading.text), text->number, 2 * text->number),
                   fmt::format("write --columns 'length={0}' for bytes, or --columns 'quantity={0}' for "
                               "registers",
                               for_columns(heading.text)));
    return;
  }
  const bool are_bytes = length == LengthOf::bytes;
  problems.warning(heading.at,
                   fmt::format("{} is read as the number of {}, for types and addresses fit only that",
                               shown(heading.text), are_bytes ? "bytes" : "registers"),
                   fmt::format("if that is wrong, write --columns '{}={}'", are_bytes ? "quantity" : "length",
                               for_columns(heading.text)));
  if (!are_bytes) become_registers(columns[i]);
}

}  // namespace coupler::formats
