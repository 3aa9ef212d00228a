// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using loader::is_digit;
using loader::is_letter;

void drop_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool take_word(std::string_view& text, std::string_view word) {
  if (text.substr(0, word.size()) != word) return false;
  text.remove_prefix(word.size());
  return true;
}

/// Takes "6553.5", "-40", "0,5" or "0x10" from the front.
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
  if (end == begin) return std::nullopt;
  const bool has_fraction = !is_hexadecimal && end + 1 < rest.size() &&
                            (rest[end] == '.' || rest[end] == ',') && is_digit(rest[end + 1]);
  if (has_fraction) end = std::min(rest.find_first_not_of("0123456789", end + 1), rest.size());
  number += rest.substr(0, end);
  std::replace(number.begin(), number.end(), ',', '.');
  text = rest.substr(end);
  if (is_hexadecimal)
    if (const auto whole = loader::parse_integer(number)) return fmt::to_string(*whole);
  return number;
}

/// Letters, "%", "/", "°" and the like: "V", "°C", "m³/h".
std::string_view take_unit(std::string_view& text) {
  const auto* end = std::find_if(text.begin(), text.end(), [](char c) {
    return !is_letter(c) && c != '%' && c != '/' && (static_cast<unsigned char>(c) & 0x80U) == 0;
  });
  auto size = static_cast<std::size_t>(end - text.begin());
  for (const std::string_view dash : {"\u2013", "\u2014", "\u2026"}) size = std::min(size, text.find(dash));
  const std::string_view unit = text.substr(0, size);
  text.remove_prefix(unit.size());
  return unit;
}

bool take_separator(std::string_view& text) {
  for (const std::string_view word :
       {"...", "..", "\u2026", "to ", "bis ", "-", "\u2013", "\u2014", "~", ";", ",", ":", "\u2192"})
    if (take_word(text, word)) return true;
  return false;
}

bool is_factor(std::string_view text) {
  const auto number = loader::parse_number(text);
  return number && *number > 0 && *number != 1;
}

/// Takes "0.1", "1/10", "10^-1" or "1e-1" from the front.
std::optional<std::string> take_factor(std::string_view& text) {
  auto number = take_number(text);
  if (!number || text.empty()) return number;
  std::string_view rest = text.substr(1);
  const auto second = take_number(rest);
  if (!second) return number;
  const bool is_power = (text[0] == '^' && *number == "10") || text[0] == 'e' || text[0] == 'E';
  if (is_power)
    number = fmt::format("{}e{}", text[0] == '^' ? "1" : *number, *second);
  else if (const auto divided = factor_of(*second); text[0] == '/' && divided)
    number = fmt::format("{}", loader::parse_number(*number).value_or(0) * *divided);
  else
    return number;
  text = rest;
  return number;
}

/// "0.1V", "0.01 Hz", "1/10 A", "x10 W"
std::optional<FactorAndUnits> factor_before(std::string_view text) {
  FactorAndUnits result;
  result.is_times = take_word(text, "x") || take_word(text, "*") || take_word(text, "\u00D7");
  drop_blanks(text);
  const auto number = take_factor(text);
  if (!number || !is_factor(*number)) return std::nullopt;
  drop_blanks(text);
  if (!take_word(text, "*")) take_word(text, "\u00D7");
  drop_blanks(text);
  result.factor = *number;
  result.units = take_unit(text);
  if (!text.empty() || result.units.empty() || result.units[0] == '/') return std::nullopt;
  return result;
}

/// Where "x10", "*10" or "/10" begins; npos if nothing of that kind is in the text.
std::size_t find_times(std::string_view text) {
  for (std::size_t at = text.size(); at-- > 0;) {
    const bool begins_word = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (text[at] == '*' || text[at] == '/' || text.substr(at, 2) == "\u00D7" ||
        ((text[at] == 'x' || text[at] == 'X') && begins_word))
      return at;
  }
  return std::string_view::npos;
}

/// "x10", "%*10", "V (x 10)", "V/10"
std::optional<FactorAndUnits> factor_behind(std::string_view text) {
  const std::size_t times = find_times(text);
  if (times == std::string_view::npos) return std::nullopt;
  FactorAndUnits result;
  const bool divides = text[times] == '/';
  std::string_view rest = text.substr(times + (text.substr(times, 2) == "\u00D7" ? 2 : 1));
  drop_blanks(rest);
  const auto number = take_factor(rest);
  take_word(rest, ")");
  drop_blanks(rest);
  if (!number || !rest.empty() || !is_factor(*number)) return std::nullopt;
  result.factor = divides ? fmt::format("{}", factor_of(*number).value_or(1)) : *number;
  result.is_times = !divides;
  const std::string_view before = text.substr(0, times);
  result.units = before.substr(0, before.find_last_not_of(" (") + 1);
  return result;
}

}  // namespace

bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos) return false;
  std::string number(text);
  number[comma] = '.';
  return loader::parse_number(number).has_value();
}

std::optional<std::string> decimal(std::string_view text) {
  std::string number(text);
  if (has_decimal_comma(text)) std::replace(number.begin(), number.end(), ',', '.');
  if (!loader::parse_number(number)) return std::nullopt;
  return number;
}

std::optional<Ends> read_range(std::string_view text) {
  drop_blanks(text);
  const bool in_brackets = take_word(text, "[") || take_word(text, "(");
  drop_blanks(text);
  const auto low = take_number(text);
  if (!low) return std::nullopt;
  drop_blanks(text);
  if (!take_separator(text)) {
    take_unit(text);  // "0 V to 10 V"
    drop_blanks(text);
    if (!take_separator(text)) return std::nullopt;
  }
  drop_blanks(text);
  const auto high = take_number(text);
  if (!high) return std::nullopt;
  drop_blanks(text);
  take_unit(text);
  if (in_brackets && !take_word(text, "]")) take_word(text, ")");
  drop_blanks(text);
  take_unit(text);
  if (!text.empty()) return std::nullopt;
  return Ends{*low, *high};
}

std::optional<FactorAndUnits> read_scaled_units(std::string_view text) {
  if (auto before = factor_before(text)) return before;
  return factor_behind(text);
}

std::optional<double> factor_of(std::string_view divisor) {
  const auto number = loader::parse_number(divisor);
  if (!number || *number == 0) return std::nullopt;
  return 1 / *number;
}

}  // namespace coupler::formats
