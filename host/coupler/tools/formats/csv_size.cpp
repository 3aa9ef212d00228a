// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/csv_scan.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using codec::Type;
using loader::Entry;
using loader::shown;

constexpr std::uint64_t most_registers = 65536;  // registers; beyond that the loader refuses

std::optional<std::uint64_t> number_of(const Entry& point, std::string_view key) {
  const Entry* entry = loader::child(point, key);
  return entry != nullptr ? loader::parse_unsigned(entry->text) : std::nullopt;
}

/// Adds the key, unless a column has said the same. Another number there is an error.
void say(const RowView& row, Entry& point, std::string_view key, std::uint64_t number, const Cell& from) {
  if (loader::child(point, key) == nullptr) {
    point.children.push_back(scalar(key, fmt::to_string(number), from.at));
    return;
  }
  if (const auto there = number_of(point, key); there && *there != number)
    row.problems.error(
        from.at, fmt::format("{} says '{}: {}', but a column says {}", shown(from.text), key, number, *there),
        "correct one of the two");
}

void add_bit(const RowView& row, RowPoint& point, const Cell& address) {
  if (!point.address.bit) return;
  if (holds_bits(point.table)) {
    row.problems.error(address.at,
                       fmt::format("{} is a bit of a register, but the point is in {}", shown(address.text),
                                   to_string(point.table)),
                       "write the address alone, or a table of registers");
    return;
  }
  if (loader::child(point.entry, "type") == nullptr)
    point.entry.children.push_back(scalar("type", "BOOL", address.at));
  say(row, point.entry, "bit", *point.address.bit, address);
}

/// A column "Bits" has the width of the type in makers' tables, which the type says already; or "8-11".
void read_bits(RowPoint& point) {
  Entry* found = find(point.entry, "bits");
  if (found == nullptr || found->kind != Entry::Kind::scalar) return;
  std::string_view rest = found->text;
  const auto first = take_number(rest);
  if (!first) return;
  if (rest.empty()) {
    const unsigned width = point.type.type ? codec::width(*point.type.type) : 0;
    if (loader::parse_unsigned(*first) == width) drop(point.entry, "bits");
    return;
  }
  drop_blanks(rest);
  if (!take_word(rest, "-") && !take_word(rest, "..") && !take_word(rest, "to")) return;
  drop_blanks(rest);
  const auto last = take_number(rest);
  if (!last || !rest.empty()) return;
  found->kind = Entry::Kind::list;
  found->children = {scalar("", *first, found->at), scalar("", *last, found->at)};
}

void add_count(const RowView& row, RowPoint& point, const Cell& address) {
  const Cell* type = row.cell("type");
  if (point.address.count) say(row, point.entry, "count", *point.address.count, address);
  if (point.type.count && type != nullptr) say(row, point.entry, "count", *point.type.count, *type);
  if (point.type.is_array && type != nullptr && loader::child(point.entry, "count") == nullptr)
    row.problems.error(
        type->at, fmt::format("{} does not say how many values it has", shown(type->text)),
        fmt::format("write the number behind the address, as in '{} [8]', or in a column 'count'",
                    point.address.text));
}

/// 6 of "string[6]" counts characters or registers.
std::uint64_t length_of(const RowView& row, const RowPoint& point, std::uint64_t number,
                        std::optional<std::uint64_t> registers) {
  const Cell& type = *row.cell("type");
  if (number > most_registers) return number;
  const auto length = number_of(point.entry, "length");
  if (length && (*length == number || *length == 2 * number)) return *length;
  const bool fits_characters = registers && *registers == (number + 1) / 2;
  const bool fits_registers = registers && *registers == number;
  if (fits_characters != fits_registers) return fits_characters ? number : 2 * number;
  if (row.options.strings == "characters") return number;
  if (row.options.strings == "registers") return 2 * number;
  row.questions.ask(
      Question::string_number, type,
      fmt::format("{0} has two meanings: {1} characters, or {1} registers, which hold {2}", shown(type.text),
                  number, 2 * number),
      fmt::format("say it for all such types with --strings characters or --strings registers; or write the "
                  "type STRING, and {} or {} in a column 'length'",
                  number, 2 * number));
  return number;
}

void add_length(const RowView& row, RowPoint& point, const Cell& address,
                std::optional<std::uint64_t> registers) {
  if (point.address.length) {
    say(row, point.entry, "length", *point.address.length, address);
    if (point.address.high_byte_first && loader::child(point.entry, "order") == nullptr &&
        loader::child(point.entry, "ignore_byteorder") == nullptr)
      point.entry.children.push_back(scalar("order", "AB", address.at));
  }
  if (point.type.number) {
    say(row, point.entry, "length", length_of(row, point, *point.type.number, registers), *row.cell("type"));
  } else if (registers && *registers <= most_registers && loader::child(point.entry, "length") == nullptr) {
    point.entry.children.push_back(scalar("length", fmt::to_string(2 * *registers), address.at));
  }
}

/// Reports a number of registers that is not the one that the type needs.
void check_registers(const RowView& row, const RowPoint& point, std::uint64_t given, const Cell& from) {
  const std::uint64_t count = std::min(number_of(point.entry, "count").value_or(1), most_registers);
  std::uint64_t needed = count;
  if (!holds_bits(point.table)) {
    if (!point.type.type) return;
    if (*point.type.type == Type::STRING)
      needed = (std::min(number_of(point.entry, "length").value_or(2 * std::min(given, most_registers)),
                         most_registers) +
                1) /
               2;
    else
      needed = count * std::max(codec::width(*point.type.type) / 16, 1U);
  }
  if (needed == given) return;
  const std::string things =
      fmt::format("{}{}", holds_bits(point.table) ? "bit" : "register", given == 1 ? "" : "s");
  row.problems.error(
      from.at, fmt::format("{} says {} {}, but the point has {}", shown(from.text), given, things, needed),
      "correct the type or this cell; the number of values of an array is 'count'");
}

}  // namespace

void add_size(const RowView& row, RowPoint& point) {
  const Cell* address = row.cell("address");
  if (address == nullptr) return;
  const Cell* cell = row.cell("registers");
  std::optional<std::uint64_t> registers;
  if (cell != nullptr) {
    registers = loader::parse_unsigned(cell->text);
    if (!registers)
      row.problems.error(cell->at, fmt::format("{} is not a number of registers", shown(cell->text)),
                         "write how many the value has, or nothing");
  }
  add_bit(row, point, *address);
  read_bits(point);
  add_count(row, point, *address);
  if (point.type.type == Type::STRING)
    add_length(row, point, *address, registers ? registers : point.address.registers);
  if (registers) check_registers(row, point, *registers, *cell);
  if (point.address.registers) check_registers(row, point, *point.address.registers, *address);
}

void add_order(const RowView& row, RowPoint& point) {
  constexpr unsigned one_register = 16;
  const Cell* type = row.cell("type");
  if (type == nullptr || !point.type.type || holds_bits(point.table)) return;
  if (codec::width(*point.type.type) <= one_register) return;
  if (const Entry* given = loader::child(point.entry, "order")) {
    if (!point.type.order.empty() && lower(given->text) != lower(point.type.order))
      row.problems.error(
          type->at,
          fmt::format("{} and the order {} contradict each other", shown(type->text), shown(given->text)),
          "correct one of the two");
    return;
  }
  const std::string& order = point.type.order.empty() ? row.options.order : point.type.order;
  if (order.empty())
    row.questions.ask(
        Question::order, *type,
        fmt::format("{} has several registers, and the table does not say which comes first: the "
                    "most significant one (ABCD), or the least (CDAB)",
                    shown(type->text)),
        "say it for all of them with --order ABCD or --order CDAB, or in a column 'order'");
  else
    point.entry.children.push_back(scalar("order", order, type->at));
}

}  // namespace coupler::formats
