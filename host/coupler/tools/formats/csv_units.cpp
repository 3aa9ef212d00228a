// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_units.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_scan.hpp"
#include "coupler/tools/formats/csv_values.hpp"

namespace coupler::formats {
namespace {

using loader::is_digit;
using loader::is_letter;

bool is_factor(std::string_view text) {
  const auto number = loader::parse_number(text);
  return number && *number > 0 && *number != 1;
}

bool is_above_one(std::string_view factor) { return loader::parse_number(factor).value_or(0) > 1; }

bool is_of_other_letters(char c) { return (static_cast<unsigned char>(c) & 0x80U) != 0; }

std::string_view without_blanks_behind(std::string_view text) {
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// Without "(" and ")" around all of it.
std::string_view without_brackets(std::string_view text) {
  const bool has_both = text.size() > 2 && ((text.front() == '(' && text.back() == ')') ||
                                            (text.front() == '[' && text.back() == ']'));
  return has_both && text.find_first_of(")]") == text.size() - 1 ? text.substr(1, text.size() - 2) : text;
}

/// "V" of "V/LSB": the factor is that of one step of the register.
std::string_view without_step(std::string_view units) {
  const std::size_t slash = units.rfind('/');
  if (slash == std::string_view::npos) return units;
  const std::string per = lower(units.substr(slash + 1));
  const bool is_step = per == "lsb" || per == "bit" || per == "digit" || per == "count" || per == "step";
  return is_step ? without_blanks_behind(units.substr(0, slash)) : units;
}

bool is_unit(std::string_view text) {
  return !text.empty() && (is_letter(text[0]) || text[0] == '%' || is_of_other_letters(text[0])) &&
         !has_number_apart(text);
}

/// "0.1V", "0.01 Hz", "1/10 A", "x10 W", "0.1 m3/h", "0.1"
std::optional<FactorAndUnits> factor_before(std::string_view text) {
  FactorAndUnits result;
  result.is_times = take_word(text, "x") || take_word(text, "*") || take_word(text, "\u00D7");
  drop_blanks(text);
  const auto number = take_factor(text);
  if (!number || !is_factor(*number)) return std::nullopt;
  drop_blanks(text);
  if (!take_word(text, "*")) take_word(text, "\u00D7");
  drop_blanks(text);
  if (!text.empty() && !is_unit(text)) return std::nullopt;
  if (text.empty() && is_above_one(*number)) result.is_times = true;
  result.factor = *number;
  result.units = without_step(text);
  return result;
}

/// Returns the place where "x10", "*10", "/10" or ":10" begins; npos if the text has nothing of that kind.
std::size_t find_operator(std::string_view text) {
  for (std::size_t at = text.size(); at-- > 0;) {
    const bool begins_word = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (text[at] == '*' || text[at] == '/' || text[at] == ':' || text.substr(at, 2) == "\u00D7" ||
        text.substr(at, 2) == "\u00F7" || ((text[at] == 'x' || text[at] == 'X') && begins_word))
      return at;
  }
  return std::string_view::npos;
}

/// The number alone, with ")" behind it or not.
std::optional<std::string> factor_alone(std::string_view text) {
  drop_blanks(text);
  const auto number = take_factor(text);
  take_word(text, ")");
  drop_blanks(text);
  return text.empty() && number && is_factor(*number) ? number : std::nullopt;
}

std::optional<FactorAndUnits> with_units(std::string_view before, std::string factor, bool is_times) {
  const std::string_view units = before.substr(0, before.find_last_not_of(" (") + 1);
  if (!units.empty() && !is_unit(units)) return std::nullopt;
  return FactorAndUnits{std::move(factor), std::string(without_step(units)), is_times};
}

/// "x10", "%*10", "V (x 10)", "V/10", "V:10"
std::optional<FactorAndUnits> factor_behind_operator(std::string_view text) {
  const std::size_t at = find_operator(text);
  if (at == std::string_view::npos) return std::nullopt;
  const bool is_long = is_of_other_letters(text[at]);
  const auto number = factor_alone(text.substr(at + (is_long ? 2 : 1)));
  if (!number) return std::nullopt;
  const bool divides = text[at] == '/' || text[at] == ':' || text.substr(at, 2) == "\u00F7";
  return with_units(text.substr(0, at), divides ? fmt::format("{}", factor_of(*number).value_or(1)) : *number,
                    !divides);
}

/// "V (0.1)", "V 10^-1"
std::optional<FactorAndUnits> factor_behind(std::string_view text) {
  const std::size_t at = text.find_last_of(" (");
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const std::string_view last = text.substr(at + 1);
  if (text[at] == ' ' && last.find_first_of(".,^") == std::string_view::npos) return std::nullopt;
  const auto number = factor_alone(last);
  return number ? with_units(text.substr(0, at), *number, is_above_one(*number)) : std::nullopt;
}

}  // namespace

std::optional<FactorAndUnits> read_scaled_units(std::string_view text) {
  text = without_brackets(without_blanks_behind(text));
  drop_blanks(text);
  if (auto before = factor_before(text)) return before;
  if (auto behind = factor_behind_operator(text)) return behind;
  return factor_behind(text);
}

bool has_number_apart(std::string_view text) {
  if (text.size() > 2 && text.substr(0, 2) == "1/" && !is_digit(text[2])) text.remove_prefix(2);
  bool is_part = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!is_digit(text[at])) continue;
    const char before = at == 0 ? ' ' : text[at - 1];
    const char second = at < 2 ? ' ' : text[at - 2];
    const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
    const bool goes_on = is_part && (before == '.' || before == ',') && is_digit(second);
    const bool is_power =
        before == '^' || ((before == '-' || before == '+') && (second == '^' || is_letter(second)));
    const bool is_amount = before == '/' && end < text.size() && is_letter(text[end]);
    is_part = goes_on || is_power || is_amount || is_letter(before) || is_of_other_letters(before);
    if (!is_part) return true;
    at = end;
  }
  return false;
}

}  // namespace coupler::formats
