// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_scan.hpp"

namespace coupler::formats {
namespace {

using loader::is_letter;

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
  for (const std::string_view word : {"...", "..", "\u2026", "to ", "bis ", "\u00E0 ", "-", "\u2013",
                                      "\u2014", "~", ";", ",", ":", "\u2192"})
    if (take_word(text, word)) return true;
  return false;
}

std::optional<std::string> take_end(std::string_view& text, Ends& ends) {
  const std::string_view whole = text;
  auto number = take_number(text);
  const char sign = sign_of_thousands(whole.substr(0, whole.size() - text.size()));
  ends.comma_may_be_of_thousands = ends.comma_may_be_of_thousands || sign == ',';
  ends.point_may_be_of_thousands = ends.point_may_be_of_thousands || sign == '.';
  return number;
}

bool holds(codec::Type type, std::int64_t number) {
  codec::Format format;
  format.type = type;
  std::array<std::uint16_t, 4> registers{};
  return codec::encode(codec::Value{number}, format, registers.data()).has_value();
}

}  // namespace

char sign_of_thousands(std::string_view number) {
  const std::size_t sign = number.find_first_of(".,");
  if (sign == std::string_view::npos || number.size() - sign != 4) return '\0';
  const bool is_below_one = number.substr(0, sign).find_first_of("123456789") == std::string_view::npos;
  return is_below_one ? '\0' : number[sign];
}

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
  Ends ends;
  drop_blanks(text);
  const bool in_brackets = take_word(text, "[") || take_word(text, "(");
  for (const std::string_view word : {"from ", "von ", "de "})
    if (take_word(text, word)) break;
  drop_blanks(text);
  const std::string_view begin = text;
  const auto low = take_end(text, ends);
  if (!low) return std::nullopt;
  const bool has_comma = begin.substr(0, begin.size() - text.size()).find(',') != std::string_view::npos;
  drop_blanks(text);
  if (has_comma && text.substr(0, 1) == ",") return std::nullopt;  // "0,1,2" is a list
  if (!take_separator(text)) {
    take_unit(text);  // "0 V to 10 V"
    drop_blanks(text);
    if (!take_separator(text)) return std::nullopt;
  }
  drop_blanks(text);
  const auto high = take_end(text, ends);
  if (!high) return std::nullopt;
  drop_blanks(text);
  take_unit(text);
  if (in_brackets && !take_word(text, "]")) take_word(text, ")");
  drop_blanks(text);
  take_unit(text);
  if (!text.empty()) return std::nullopt;
  ends.low = *low;
  ends.high = *high;
  return ends;
}

std::vector<NumberAndName> read_names(std::string_view text, codec::Type type) {
  std::vector<NumberAndName> names;
  std::set<std::int64_t> seen_values;
  std::set<std::string_view> seen_names;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(";,|/\n"), text.size());
    std::string_view entry = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    drop_blanks(text);
    const std::size_t sign = entry.find_first_of("=:");
    if (sign == std::string_view::npos) return {};
    const std::string_view number = without_blanks(entry.substr(0, sign));
    const std::string_view name = without_blanks(entry.substr(sign + 1));
    const auto value = loader::parse_integer(number);
    if (!value || !loader::is_value_name(name) || !holds(type, *value)) return {};
    if (!seen_values.insert(*value).second || !seen_names.insert(name).second) return {};
    names.push_back({std::string(number), std::string(name)});
  }
  return names;
}

bool is_raw_range(const Ends& ends, codec::Type type) {
  using codec::Type;
  const bool is_signed = type == Type::SINT || type == Type::INT || type == Type::DINT || type == Type::LINT;
  const bool is_real = type == Type::REAL || type == Type::LREAL || type == Type::STRING;
  const double steps = std::ldexp(1.0, static_cast<int>(codec::width(type)));
  const double low = is_signed ? -steps / 2 : 0;
  return !is_real && loader::parse_number(ends.low) == low &&
         loader::parse_number(ends.high) == low + steps - 1;
}

std::string factor_text(std::string_view cell, Reading reading) {
  std::string_view rest = cell;
  auto number = take_factor(rest);
  if (!number || !rest.empty()) number = decimal(cell);
  if (!number) return std::string(cell);
  if (reading == Reading::divisor) {
    const auto factor = factor_of(*number);
    return factor ? fmt::format("{}", *factor) : std::string(cell);
  }
  if (reading != Reading::exponent) return loader::parse_number(cell) ? std::string(cell) : *number;
  const auto exponent = loader::parse_integer(*number);
  constexpr int most = 30;
  if (!exponent || *exponent < -most || *exponent > most) return fmt::format("10^{}", cell);
  return fmt::format("{}", loader::parse_number(fmt::format("1e{}", *exponent)).value_or(1));
}

bool says_nothing(std::string_view cell) {
  const std::string word = lower(cell);
  for (const std::string_view nothing : {"", "-", "--", "---", "\u2013", "\u2014", "n/a", "n.a.", "none"})
    if (word == nothing) return true;
  return cell == "NA";  // "nA" are units
}

std::optional<double> factor_of(std::string_view divisor) {
  const auto number = loader::parse_number(divisor);
  if (!number || *number == 0) return std::nullopt;
  return 1 / *number;
}

}  // namespace coupler::formats
