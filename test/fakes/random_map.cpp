// SPDX-License-Identifier: Apache-2.0
#include "test/fakes/random_map.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "coupler/codec/format.hpp"
#include "coupler/codec/type_name.hpp"

namespace coupler::fakes {
namespace {

/// BOOL and the 8-bit types share registers: add_shared().
constexpr std::array<std::string_view, 11> whole_types{"WORD", "DWORD", "LWORD", "INT",  "DINT", "LINT",
                                                       "UINT", "UDINT", "ULINT", "REAL", "LREAL"};
constexpr std::array<std::string_view, 4> byte_types{"BYTE", "SINT", "USINT", "CHAR"};
constexpr std::array<std::string_view, 4> orders{"ABCD", "CDAB", "BADC", "DCBA"};

}  // namespace

RandomMap::RandomMap(std::uint32_t seed, unsigned most_points_a_table)
    : random_(seed), most_points_(most_points_a_table) {
  head_ = head();
  for (const Table table : tables) holds_bits(table) ? add_bits(table) : add_registers(table);
  if (head_.find("read_whole") != std::string::npos)
    rows_.push_back({fmt::format("p{}", names_++), Table::input_registers, 60012, 1, "", ", type: UINT", ""});
  for (Row& row : rows_)
    if (one_in(4)) add_initial(row);
}

std::uint32_t RandomMap::below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }

std::string RandomMap::head() {
  std::string text = fmt::format("name: random_{}\nrate: {}\n", below(1000), 100 + below(300));
  if (one_in(2)) text += "byteorder_reverse: true\n";
  if (one_in(2)) text += "wordorder_reverse: true\n";
  if (one_in(2)) text += fmt::format("registers_read_continuous: {}\n", one_in(2));
  if (one_in(2)) text += fmt::format("address: 10.0.0.{}\nport: {}\n", 1 + below(254), 1 + below(65535));
  // Where no other point is.
  if (one_in(4)) text += "unreadable: [{table: input_registers, from: 60000, to: 60009}]\n";
  if (one_in(4)) text += "read_whole: [{table: input_registers, from: 60010, to: 60019}]\n";
  if (one_in(3)) text += fmt::format("limits: {{read_registers: {}}}\n", 32 + below(94));
  return text;
}

void RandomMap::add_bits(Table table) {
  std::uint32_t address = below(100);
  for (std::uint32_t left = below(most_points_ + 1); left > 0; --left) {
    const std::uint32_t size = one_in(4) ? 2 + below(20) : 1;
    rows_.push_back({fmt::format("p{}", names_++), table, address, size, "",
                     size > 1 ? fmt::format(", count: {}", size) : "", options(table, false)});
    address += size + (one_in(2) ? below(30) : 0);
  }
}

void RandomMap::add_registers(Table table) {
  std::uint32_t address = below(1000);
  for (std::uint32_t left = below(most_points_ + 1); left > 0; --left) {
    std::uint32_t size = 1;
    if (one_in(3)) {
      size = add_shared(table, address);
    } else {
      std::string text;
      size = format(text);
      const bool scalable = text.find("WORD") == std::string::npos && text.find("STR") == std::string::npos;
      rows_.push_back(
          {fmt::format("p{}", names_++), table, address, size, "", text, options(table, scalable)});
    }
    address += size + (one_in(2) ? below(40) : 0);
  }
}

/// Several bits of one register, or its two bytes.
std::uint32_t RandomMap::add_shared(Table table, std::uint32_t address) {
  if (one_in(2)) {
    for (const std::string_view half : {"high", "low"})
      rows_.push_back({fmt::format("p{}", names_++), table, address, 1, fmt::format(", offset: {}", half),
                       fmt::format(", type: {}", byte_types[below(byte_types.size())]), ""});
    return 1;
  }
  if (one_in(3)) {
    const std::uint32_t cut = 2 + below(11);
    const std::string_view order = one_in(2) ? ", order: BA" : "";
    for (const auto& [first, last] : {std::pair(0U, cut - 1), std::pair(cut + 1, 15U)})
      if (last > first)
        rows_.push_back({fmt::format("p{}", names_++), table, address, 1,
                         fmt::format(", bits: [{}, {}]", first, last),
                         fmt::format(", type: {}{}", one_in(2) ? "UINT" : "WORD", order), ""});
    return 1;
  }
  for (std::uint32_t bit = below(4); bit < 16; bit += 1 + below(6))
    rows_.push_back({fmt::format("p{}", names_++), table, address, 1, fmt::format(", bit: {}", bit),
                     ", type: BOOL", options(table, false)});
  return 1;
}

/// A type of whole registers; how many it has.
std::uint32_t RandomMap::format(std::string& text) {
  if (one_in(8)) {
    const std::uint32_t length = 1 + below(60);
    text = fmt::format(", type: STRING, length: {}{}{}", length, one_in(2) ? ", ignore_byteorder: true" : "",
                       one_in(3) ? ", encoding: latin-1" : "");
    return (length + 1) / 2;
  }
  const std::string_view type = whole_types[below(whole_types.size())];
  const std::uint32_t registers = codec::width(*codec::parse_type(type)) / 16;
  text = fmt::format(", type: {}", type);
  if (one_in(2))
    text += fmt::format(", order: {}", registers > 1 ? orders[below(orders.size())]
                                       : one_in(2)   ? "AB"
                                                     : "BA");
  const std::uint32_t count = one_in(4) ? 2 + below(6) : 1;
  if (count > 1) text += fmt::format(", count: {}", count);
  return registers * count;
}

std::string RandomMap::options(Table table, bool scalable) {
  std::string text;
  if (scalable && one_in(4))
    text += fmt::format(", scale: {{gain: {}, offset: {}}}", 0.5 * (2 + below(9)), below(5));
  const bool write_only = is_writable(table) && one_in(8);
  if (write_only) text += ", access: write";
  if (one_in(4)) text += fmt::format(", description: number {}", below(100));
  if (!holds_bits(table) && one_in(4)) text += one_in(2) ? ", units: mm" : ", units: bar";
  if (!write_only && one_in(6)) text += fmt::format(", rate: {}", 50 + below(300));
  return text;
}

/// A value that fits into every type that the point may have.
void RandomMap::add_initial(Row& row) {
  if (row.options.find("scale") != std::string::npos)
    return;  // it would be in units, and may be out of range
  if (holds_bits(row.table) || row.format.find("BOOL") != std::string::npos)
    row.format += ", initial: on";
  else if (row.format.find("STRING") != std::string::npos)
    row.format += fmt::format(", initial: \"{}\"", static_cast<char>('A' + below(26)));
  else
    row.format +=
        fmt::format(", initial: {}", row.part.find("bits") == std::string::npos ? below(128) : below(4));
}

std::string RandomMap::keys_of(const Row& row) {
  std::string keys = row.address ? fmt::format(", address: {}", *row.address) : std::string();
  keys += row.part + row.format + row.options;
  return keys.empty() ? keys : keys.substr(2);
}

std::string RandomMap::yaml() const {
  std::string text = head_ + "mapping:\n";
  for (const Table table : tables) {
    std::string points;
    for (const Row& row : rows_)
      if (row.table == table) points += fmt::format("    {}: {{{}}}\n", row.name, keys_of(row));
    text += fmt::format("  {}:{}{}", to_string(table), points.empty() ? " {}\n" : "\n", points);
  }
  return text + tail_;
}

std::string RandomMap::edit() {
  if (rows_.empty() || one_in(10)) {
    head_ = head();
    return "the device's keys";
  }
  const std::uint32_t which = below(static_cast<std::uint32_t>(rows_.size()));
  Row& row = rows_[which];
  const std::string name = row.name;
  switch (below(7)) {
    case 0: rows_.erase(rows_.begin() + which); return name + " removed";
    case 1: row.address = row.address.value_or(0) + 1 + below(500); return name + " moved";
    case 2: row.name = fmt::format("p{}", names_++); return name + " renamed";
    case 3:
      if (holds_bits(row.table) || !row.part.empty()) return "nothing";
      row.options.clear();
      row.size = format(row.format);
      return name + " of another type";
    case 4: row.options = options(row.table, false); return name + " with other options";
    case 5:
      rows_.push_back({fmt::format("p{}", names_++), row.table, 20000 + below(20000), 1, "",
                       holds_bits(row.table) ? "" : ", type: UINT", ""});
      return "a point added";
    default: return "nothing";
  }
}

}  // namespace coupler::fakes
