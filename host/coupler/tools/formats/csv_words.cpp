// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_words.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

constexpr std::string_view names_of_tables =
    "write coils, discrete_inputs, input_registers or holding_registers";

struct Word {
  std::string_view said;  ///< in lower case, letters and digits only
  std::string_view meant;
};

constexpr Word accesses[] = {
    {"r", "read"},
    {"ro", "read"},
    {"rd", "read"},
    {"read", "read"},
    {"readonly", "read"},
    {"lesen", "read"},
    {"lecture", "read"},
    {"nurlesen", "read"},
    {"w", "write"},
    {"wo", "write"},
    {"wr", "write"},
    {"write", "write"},
    {"writeonly", "write"},
    {"schreiben", "write"},
    {"nurschreiben", "write"},
    {"rw", "read_write"},
    {"readwrite", "read_write"},
    {"readandwrite", "read_write"},
    {"writeread", "read_write"},
    {"lectureecriture", "read_write"},
    {"lecturecriture", "read_write"},  // "É" is no letter here
    {"lesenschreiben", "read_write"},
    {"lesenundschreiben", "read_write"},
    {"schreibenlesen", "read_write"},
};

struct NameOfTable {
  std::string_view said;
  Table meant;
};
constexpr NameOfTable table_words[] = {
    {"coil", Table::coils},
    {"coils", Table::coils},
    {"co", Table::coils},
    {"do", Table::coils},
    {"0x", Table::coils},
    {"0xxxx", Table::coils},
    {"0xxxxx", Table::coils},
    {"digitaloutput", Table::coils},
    {"discreteinput", Table::discrete_inputs},
    {"discreteinputs", Table::discrete_inputs},
    {"discrete", Table::discrete_inputs},
    {"di", Table::discrete_inputs},
    {"1x", Table::discrete_inputs},
    {"1xxxx", Table::discrete_inputs},
    {"1xxxxx", Table::discrete_inputs},
    {"digitalinput", Table::discrete_inputs},
    {"contact", Table::discrete_inputs},
    {"inputstatus", Table::discrete_inputs},
    {"inputregister", Table::input_registers},
    {"inputregisters", Table::input_registers},
    {"ir", Table::input_registers},
    {"3x", Table::input_registers},
    {"3xxxx", Table::input_registers},
    {"3xxxxx", Table::input_registers},
    {"analoginput", Table::input_registers},
    {"holdingregister", Table::holding_registers},
    {"holdingregisters", Table::holding_registers},
    {"holding", Table::holding_registers},
    {"hr", Table::holding_registers},
    {"4x", Table::holding_registers},
    {"4xxxx", Table::holding_registers},
    {"4xxxxx", Table::holding_registers},
    {"analogoutput", Table::holding_registers},
};

/// Function codes of Modbus V1.1b3, section 6, and Modicon's first digit of an area, by number.
struct Code {
  unsigned number;
  Table table;
  bool writes;
};
constexpr Code codes[] = {{1, Table::coils, false},
                          {2, Table::discrete_inputs, false},
                          {3, Table::holding_registers, false},
                          {4, Table::input_registers, false},
                          {5, Table::coils, true},
                          {6, Table::holding_registers, true},
                          {15, Table::coils, true},
                          {16, Table::holding_registers, true},
                          {22, Table::holding_registers, true},
                          {23, Table::holding_registers, false}};

/// Words for two tables, the one of bits first.
struct NameOfTwo {
  std::string_view said;
  Table bits;
  Table registers;
};
constexpr NameOfTwo words_of_two[] = {
    {"input", Table::discrete_inputs, Table::input_registers},
    {"inputs", Table::discrete_inputs, Table::input_registers},
    {"output", Table::coils, Table::holding_registers},
    {"outputs", Table::coils, Table::holding_registers},
};

const Code* find_code(std::uint64_t number) {
  const auto* found =
      std::find_if(std::begin(codes), std::end(codes), [&](const Code& c) { return c.number == number; });
  return found == std::end(codes) ? nullptr : found;
}

/// "03/16" and "0x03, 0x10" as their numbers; empty if anything else is between them.
std::vector<std::string_view> numbers_of(std::string_view text) {
  std::vector<std::string_view> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" /,;+&"), text.size()));
    if (text.empty()) return numbers;
    numbers.push_back(text.substr(0, text.find_first_of(" /,;+&")));
    if (!loader::parse_unsigned(numbers.back())) return {};
    text.remove_prefix(numbers.back().size());
  }
}

/// "Holding" of "Holding (FC03)"; the text itself if it does not end with brackets.
std::string_view without_brackets_behind(std::string_view text) {
  constexpr std::size_t longest = 100;  // brackets in brackets are read one by one
  if (text.empty() || text.size() > longest || (text.back() != ')' && text.back() != ']')) return text;
  const std::string_view before = text.substr(0, std::min(text.find_first_of("(["), text.size()));
  const std::size_t last = before.find_last_not_of(' ');
  return last == std::string_view::npos ? text : before.substr(0, last + 1);
}

/// Behind "FC" or "function code"; the text itself if neither stands there.
std::string_view without_fc(std::string_view text) {
  const std::string low = lower(text);
  for (const std::string_view word : {"function code", "function", "fc"})
    if (low.compare(0, word.size(), word) == 0) return text.substr(word.size());
  return text;
}

/// Reads a cell of a column such as "Writable", where people tick rows and leave the others empty.
std::optional<bool> answer(std::string_view text) {
  const std::string word = lower(text);
  for (const std::string_view yes : {"x", "1", "y", "j", "ja", "\u2713", "\u2714"})
    if (word == yes) return true;
  for (const std::string_view no : {"", "-", "0", "n", "nein", "n/a", "\u2717", "\u2718"})
    if (word == no) return false;
  return loader::parse_boolean(word);
}

TableWord table_of_codes(const std::vector<std::string_view>& numbers, std::string_view text) {
  TableWord word;
  for (const std::string_view number : numbers) {
    const Code* code = find_code(*loader::parse_unsigned(number));
    if (code == nullptr)
      return {std::nullopt, Codes::none,
              fmt::format("{} is not a function code that reads or writes a table", loader::shown(number)),
              "write 1, 2, 3 or 4, or 5, 6, 15 or 16; a hexadecimal one as 0x10"};
    if (word.table && *word.table != code->table)
      return {
          std::nullopt, Codes::none,
          fmt::format("{} is {} and {}", loader::shown(text), to_string(*word.table), to_string(code->table)),
          "give each of the two a row of its own"};
    word.table = code->table;
    const Codes does = code->writes ? Codes::write : Codes::read;
    word.codes = word.codes == Codes::none || word.codes == does ? does : Codes::read_and_write;
  }
  return word;
}

/// A number alone is a function code to one, and Modicon's area to another.
TableWord ambiguous(std::string_view text, std::uint64_t number) {
  const Code* code = find_code(number);
  const auto area = number < 10 ? table_of_modicon(fmt::format("{}0001", number)) : std::nullopt;
  std::string meanings;
  if (code != nullptr) meanings = fmt::format("{} as a function code", to_string(code->table));
  if (area)
    meanings +=
        fmt::format("{}{} as an area ({}x)", meanings.empty() ? "" : " and ", to_string(*area), number);
  if (meanings.empty())
    return {std::nullopt, Codes::none, fmt::format("{} is not a table", loader::shown(text)),
            std::string(names_of_tables)};
  std::string remedy;
  if (code != nullptr) remedy = fmt::format("write FC{}", number);
  if (area) remedy += fmt::format("{} {}x", remedy.empty() ? "write" : " or", number);
  return {std::nullopt, Codes::none, fmt::format("{} alone is {}", loader::shown(text), meanings),
          remedy + ", or call the column FC if it has function codes"};
}

}  // namespace

TableWord read_table(std::string_view text, bool function_codes, Holds holds) {
  if (const std::string_view outside = without_brackets_behind(text); outside.size() < text.size()) {
    TableWord first = read_table(outside, function_codes, holds);
    const std::string_view inside = text.substr(text.find_first_of("([") + 1);
    const TableWord second = read_table(inside.substr(0, inside.size() - 1), function_codes, holds);
    if (first.table && second.table && *first.table != *second.table)
      return {std::nullopt, Codes::none,
              fmt::format("{} is {} and {}", loader::shown(text), to_string(*first.table),
                          to_string(*second.table)),
              "write the one that the device's manual means"};
    if (first.table) return first;
  }
  const std::string word = letters_and_digits(text);
  for (const auto& [said, meant] : table_words)
    if (word == said) return {meant, Codes::none, "", ""};
  for (const auto& [said, bits, registers] : words_of_two) {
    if (word != said) continue;
    if (holds == Holds::registers) return {registers, Codes::none, "", ""};
    return {std::nullopt, Codes::none,
            fmt::format("{} is {} or {}", loader::shown(text), to_string(bits), to_string(registers)),
            "write the one that the device's manual means"};
  }
  const std::string_view bare = without_fc(text);
  const auto numbers = numbers_of(bare);
  if (!numbers.empty() && (function_codes || bare.size() != text.size()))
    return table_of_codes(numbers, text);
  if (numbers.size() == 1) return ambiguous(text, *loader::parse_unsigned(numbers[0]));
  return {std::nullopt, Codes::none, fmt::format("{} is not a table", loader::shown(text)),
          std::string(names_of_tables)};
}

std::optional<Table> table_of_modicon(std::string_view address) {
  if (address.size() != 5 && address.size() != 6) return std::nullopt;
  switch (address[0]) {
    case '0': return Table::coils;
    case '1': return Table::discrete_inputs;
    case '3': return Table::input_registers;
    case '4': return Table::holding_registers;
    default: return std::nullopt;
  }
}

std::string_view access_of(std::string_view text, Reading reading) {
  if (reading == Reading::may_be_written || reading == Reading::may_not_be_written)
    if (const auto yes = answer(text))
      return *yes == (reading == Reading::may_be_written) ? "read_write" : "read";
  // "WR" stands beside "RD", but "W/R" is both.
  const std::string word = lower(text) == "w/r" ? "rw" : letters_and_digits(text);
  for (const auto& [said, meant] : accesses)
    if (word == said) return meant;
  const std::string_view outside = without_brackets_behind(text);
  return outside.size() < text.size() ? access_of(outside, reading) : text;
}

}  // namespace coupler::formats
