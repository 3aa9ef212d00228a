// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_address.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_scan.hpp"
#include "coupler/tools/formats/csv_words.hpp"

namespace coupler::formats {
namespace {

using codec::Type;
using loader::Addressing;
using loader::is_digit;
using loader::shown;

constexpr std::size_t most_digits = 6;
constexpr std::size_t digits_of_thousands = 3;

bool has_digits_only(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

class AddressReader {
 public:
  AddressReader(std::string_view whole, const TypeCell& type, Addressing addressing)
      : whole_(whole), type_(type), is_modicon_(addressing == Addressing::modicon) {}

  AddressCell run() {
    std::string_view text = whole_;
    if (text.substr(0, 1) == "%")
      refuse(fmt::format("{} is a variable in a PLC's program, not a Modbus address", shown(whole_)),
             "write the Modbus address that the PLC's manual gives for it; it differs between makers");
    take_count(text);
    take_table(text);
    take_point(text);
    take_range(text);
    if (!cell_.what.empty()) return std::move(cell_);
    cell_.text = with_digit_of_table(text);
    if (is_modicon_) check_modicon();
    return std::move(cell_);
  }

 private:
  /// The first reason is the one that is told.
  void refuse(std::string what, std::string remedy) {
    if (!cell_.what.empty()) return;
    cell_.what = std::move(what);
    cell_.remedy = std::move(remedy);
  }

  std::string is_no_address() const {
    return fmt::format("{} is not a{}", shown(whole_), is_modicon_ ? " Modicon number" : "n address");
  }

  /// "400060 [8]"
  void take_count(std::string_view& text) {
    if (text.empty() || text.back() != ']') return;
    const std::size_t open = text.find('[');
    const std::string_view inside =
        open == std::string_view::npos ? "" : text.substr(open + 1, text.size() - open - 2);
    // "HR[20]" has its number in brackets.
    if (open != std::string_view::npos && text.find_first_of("0123456789") > open) return;
    if (!has_digits_only(inside))
      return refuse(is_no_address(),
                    "write the first address; an array has its number of values in a "
                    "column 'count', and it has one dimension");
    cell_.count = loader::parse_unsigned(inside);
    text = without_blanks(text.substr(0, open));
  }

  /// "HR20", "HR 20", "HR[20]", "Coil 5", "4x00020"
  void take_table(std::string_view& text) {
    if (text.size() > 2 && (text[1] == 'x' || text[1] == 'X') && is_digit(text[0])) return take_x(text);
    const std::size_t begin = text.find_first_of("0123456789");
    if (begin == 0 || begin == std::string_view::npos) return;
    const std::string_view named = without_blanks(text.substr(0, begin));
    if (lower(named) == "fc") return take_function_code(text, begin);
    const bool is_number = type_.type && *type_.type != Type::BOOL;
    const TableWord word = read_table(named, false, is_number ? Holds::registers : Holds::anything);
    if (!word.table) return;
    cell_.table = word.table;
    text.remove_prefix(begin);
    if (whole_.back() == ']' && text.back() == ']') text.remove_suffix(1);
  }

  /// "FC3 30", "FC03:30"
  void take_function_code(std::string_view& text, std::size_t begin) {
    const std::size_t end = text.find_first_not_of("0123456789", begin);
    if (end == std::string_view::npos || (text[end] != ' ' && text[end] != ':')) return;
    const TableWord word = read_table(text.substr(0, end), true);
    if (!word.table) return refuse(word.what, word.remedy);
    cell_.table = word.table;
    text = without_blanks(text.substr(end + 1));
  }

  /// "4x00020". "0x20" is hexadecimal where addresses are zero-based.
  void take_x(std::string_view& text) {
    if (!is_modicon_ && text[0] == '0') return;
    cell_.table = table_of_modicon(fmt::format("{}0001", text[0]));
    if (!cell_.table) return;
    if (!is_modicon_)
      return refuse(fmt::format("{} is a Modicon number, which counts from 1", shown(whole_)),
                    "read the file with --addressing modicon, or write the zero-based address");
    has_digit_of_table_ = true;
    text.remove_prefix(2);
  }

  /// "1,002" and "1.002"
  void refuse_thousands(std::string_view before, std::string_view behind, const std::string& other) {
    refuse(fmt::format("{} has two readings: {}{} with a sign between the thousands, or {}", shown(whole_),
                       before, behind, other),
           fmt::format("write {}{} if that is the address", before, behind));
  }

  /// "400020.03" and "400020:3" are a bit, "400030.20H" a text of 20 bytes.
  void take_point(std::string_view& text) {
    const std::size_t point = text.find_first_of(".:");
    if (point == std::string_view::npos || text.substr(point, 2) == "..") return;
    const std::string_view base = text.substr(0, point);
    std::string_view behind = text.substr(point + 1);
    const char last = behind.empty() ? ' ' : behind.back();
    const bool has_byte = std::string_view("HhLl").find(last) != std::string_view::npos;
    if (has_byte) behind.remove_suffix(1);
    const auto number = has_digits_only(behind) ? loader::parse_unsigned(behind) : std::nullopt;
    if (!number || (!has_digits_only(base) && !loader::parse_unsigned(base)))
      return refuse(is_no_address(), number_remedy());
    text = base;
    if (!has_byte && behind.size() == digits_of_thousands)
      return refuse_thousands(base, behind, fmt::format("the bit {} of register {}", *number, base));
    if (type_.type == Type::STRING)
      take_text(*number, has_byte, last);
    else if (has_byte)
      refuse(fmt::format("{} is a text of {} bytes, but its type is {}", shown(whole_), *number,
                         shown(type_.text)),
             "write the type STRING, or the address alone");
    else if (type_.type && type_.type != Type::BOOL && *number <= 15)  // NOLINT: a register's last bit
      refuse(is_no_address(), fmt::format("a bit is type: BOOL, bit: {} at {}", *number, base));
    else if (type_.type && type_.type != Type::BOOL)
      refuse(is_no_address(), number_remedy());
    else if (*number > 15)  // NOLINT: a register's last bit
      refuse(fmt::format("{} has no bit: a register has the bits 0 to 15, not {}", shown(whole_), *number),
             "write one of them behind the point");
    else
      cell_.bit = number;
  }

  void take_text(std::uint64_t bytes, bool has_byte, char last) {
    cell_.length = bytes;
    cell_.high_byte_first = last == 'H' || last == 'h';
    if (!has_byte)
      refuse(fmt::format("{} does not say which byte of a register is first in its text", shown(whole_)),
             fmt::format("write {0}H if it is the high one, or {0}L", whole_));
  }

  /// "40001-40002"
  void take_range(std::string_view& text) {
    for (const std::string_view between :
         {"...", "..", "\u2026", "-", "\u2013", "\u2014", "/", ",", " to "}) {
      const std::size_t at = text.find(between);
      if (at == std::string_view::npos || at == 0) continue;
      const std::string_view first = without_blanks(text.substr(0, at));
      std::string_view last = without_blanks(text.substr(at + between.size()));
      if (between == "," && last.size() == digits_of_thousands && has_digits_only(last))
        return refuse_thousands(first, last, fmt::format("the addresses {} and {}", first, last));
      const std::string_view before = whole_.substr(0, whole_.find(first));  // "HR20-HR21"
      if (!before.empty() && last.substr(0, before.size()) == before) last.remove_prefix(before.size());
      const auto begin = loader::parse_unsigned(first);
      const auto end = loader::parse_unsigned(last);
      if (!begin || !end || *end < *begin)
        return refuse(is_no_address(), "write the first address; the type says how many registers follow");
      cell_.registers = *end - *begin + 1;
      text = first;
      return;
    }
  }

  /// "4x20" -> "400020"
  std::string with_digit_of_table(std::string_view text) const {
    if (!has_digit_of_table_) return std::string(text);
    return fmt::format("{}{:0>5}", whole_[0], text);
  }

  std::string number_remedy() const {
    return is_modicon_ ? "write a number such as 40001 or 400001" : "write the zero-based address";
  }

  void check_modicon() {
    if (!has_digits_only(cell_.text) || cell_.text.size() > most_digits)
      return refuse(is_no_address(), number_remedy());
    const bool has_digit = cell_.text.size() > 4;
    if (has_digit && !table_of_modicon(cell_.text))
      return refuse(is_no_address(),
                    "it begins with 0 (coils), 1 (discrete inputs), 3 (input registers) or 4 (holding "
                    "registers)");
    if (has_digit && !cell_.table) cell_.table = table_of_modicon(cell_.text);
  }

  std::string_view whole_;
  const TypeCell& type_;
  bool is_modicon_;
  bool has_digit_of_table_ = false;
  AddressCell cell_;
};

}  // namespace

AddressCell read_address_cell(std::string_view text, const TypeCell& type, Addressing addressing) {
  return AddressReader(text, type, addressing).run();
}

}  // namespace coupler::formats
