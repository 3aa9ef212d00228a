// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <optional>

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

/// The number of registers between the row's address and the next one of its table; nullopt if none follows.
std::optional<std::uint64_t> room_of(const std::vector<Column>& columns, const std::vector<Row>& rows,
                                     const Row& row) {
  const std::size_t address = find_column(columns, "address");
  const auto begin = loader::parse_unsigned(text_at(row, address));
  if (!begin) return std::nullopt;
  std::optional<std::uint64_t> room;
  for (auto other = rows.begin() + 1; other != rows.end(); ++other) {
    const auto next = loader::parse_unsigned(text_at(*other, address));
    if (!next || *next <= *begin) continue;
    bool is_of_it = true;
    for (const std::string_view key : {"table", "unit"}) {
      const std::size_t i = find_column(columns, key);
      is_of_it = is_of_it && text_at(*other, i) == text_at(row, i);
    }
    if (is_of_it) room = std::min(room.value_or(*next - *begin), *next - *begin);
  }
  return room;
}

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

LengthOf length_by_addresses(const std::vector<NumberOfRow>& numbers, const std::vector<Column>& columns,
                             const std::vector<Row>& rows) {
  bool fills_registers = false;
  for (const NumberOfRow& each : numbers) {
    if (!each.is_text) continue;
    const auto room = room_of(columns, rows, *each.row);
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
  const auto is_all_registers = [](const NumberOfRow& each) {
    return each.is_text || each.number == each.registers;
  };
  const auto is_open = [](const NumberOfRow& each) {
    return each.number > 1 && (each.is_text || each.registers > 1);
  };
  const auto open = std::find_if(numbers.begin(), numbers.end(), is_open);
  columns[i].reading = Reading::plain;
  if (open == numbers.end()) return;
  if (std::all_of(numbers.begin(), numbers.end(), is_all_registers)) return become_registers(columns[i]);
  const Cell& heading = rows.front()[i];
  problems.error(
      heading.at,
      fmt::format("{} has two meanings: {} beside {} is the number of values of an array, or of registers",
                  shown(heading.text), open->number,
                  shown(text_at(*open->row, find_column(columns, "type")))),
      fmt::format("write --columns 'count={0}' for values, or --columns 'quantity={0}' for registers",
                  heading.text));
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
  if (length == LengthOf::unknown) length = length_by_addresses(numbers, columns, rows);
  const Cell& heading = rows.front()[i];
  if (length == LengthOf::unknown) {
    problems.error(heading.at,
                   fmt::format("{} has two meanings: {} is the number of bytes of a text, or of registers, "
                               "which hold {}",
                               shown(heading.text), text->number, 2 * text->number),
                   fmt::format("write --columns 'length={0}' for bytes, or --columns 'quantity={0}' for "
                               "registers",
                               heading.text));
    return;
  }
  const bool are_bytes = length == LengthOf::bytes;
  problems.warning(heading.at,
                   fmt::format("{} is read as the number of {}, for types and addresses fit only that",
                               shown(heading.text), are_bytes ? "bytes" : "registers"),
                   fmt::format("if that is wrong, write --columns '{}={}'", are_bytes ? "quantity" : "length",
                               heading.text));
  if (!are_bytes) become_registers(columns[i]);
}

}  // namespace coupler::formats
