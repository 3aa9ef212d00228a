// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_scan.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_values.hpp"

namespace coupler::formats {

using loader::is_digit;

void drop_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

std::string_view without_blanks(std::string_view text) {
  drop_blanks(text);
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

bool take_word(std::string_view& text, std::string_view word) {
  if (text.substr(0, word.size()) != word) return false;
  text.remove_prefix(word.size());
  return true;
}

std::optional<std::string> take_number(std::string_view& text) {
  std::string_view rest = text;
  std::string number;
  for (const std::string_view sign : {"-", "\u2212", "+"})
    if (number.empty() && take_word(rest, sign) && sign != "+") number = "-";
  const bool is_hexadecimal = rest.substr(0, 2) == "0x" || rest.substr(0, 2) == "0X";
  const std::size_t begin = is_hexadecimal ? 2 : 0;
  std::size_t end = is_hexadecimal ? rest.find_first_not_of("0123456789abcdefABCDEF", begin)
                                   : rest.find_first_not_of("0123456789");
  end = std::min(end, rest.size());
  const bool has_fraction = !is_hexadecimal && end + 1 < rest.size() &&
                            (rest[end] == '.' || (rest[end] == ',' && end > 0)) && is_digit(rest[end + 1]);
  if (end == begin && !has_fraction) return std::nullopt;
  if (end == begin) number += '0';
  if (has_fraction) end = std::min(rest.find_first_not_of("0123456789", end + 1), rest.size());
  number += rest.substr(0, end);
  std::replace(number.begin(), number.end(), ',', '.');
  text = rest.substr(end);
  if (is_hexadecimal)
    if (const auto whole = loader::parse_integer(number)) return fmt::to_string(*whole);
  return number;
}

std::optional<std::string> take_factor(std::string_view& text) {
  auto number = take_number(text);
  if (!number || text.empty()) return number;
  std::string_view rest = text.substr(1);
  const auto second = take_number(rest);
  if (!second) return number;
  const bool is_power = (text[0] == '^' && *number == "10") || text[0] == 'e' || text[0] == 'E';
  const bool is_part = text[0] == '/' || text[0] == ':';
  if (is_power)
    number = fmt::format("{}e{}", text[0] == '^' ? "1" : *number, *second);
  else if (const auto divided = factor_of(*second); is_part && divided)
    number = fmt::format("{}", loader::parse_number(*number).value_or(0) * *divided);
  else
    return number;
  text = rest;
  return number;
}

}  // namespace coupler::formats
