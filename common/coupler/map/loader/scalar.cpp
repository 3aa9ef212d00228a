// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/scalar.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace coupler::loader {
namespace {

template <class T>
std::optional<T> whole(std::string_view text, int base) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
  const std::string_view prefix = text.substr(0, 2);
  if (prefix == "0x" || prefix == "0X") return whole<std::uint64_t>(text.substr(2), 16);
  return whole<std::uint64_t>(text, 10);
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  if (text.substr(0, 1) == "-") return whole<std::int64_t>(text, 10);
  const auto value = parse_unsigned(text);
  if (!value || *value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

std::optional<double> parse_number(std::string_view text) {
  const std::size_t first = text.substr(0, 1) == "-" ? 1 : 0;
  if (first >= text.size() || (!is_digit(text[first]) && text[first] != '.')) return {};
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<bool> parse_boolean(std::string_view text) {
  constexpr std::size_t longest = 5;
  if (text.size() > longest) return std::nullopt;
  const std::string word = lower(text);
  if (word == "true" || word == "yes" || word == "on") return true;
  if (word == "false" || word == "no" || word == "off") return false;
  return std::nullopt;
}

std::optional<std::chrono::microseconds> parse_duration(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"us", 1}, {"ms", 1e3}, {"s", 1e6}, {"min", 60e6}}};
  constexpr double day = 24 * 3600e6;
  if (text == "0") return std::chrono::microseconds{0};
  const std::size_t last = text.find_last_of("0123456789.");
  if (last == std::string_view::npos) return std::nullopt;
  const auto number = parse_number(text.substr(0, last + 1));
  for (const auto& [unit, factor] : units) {
    if (text.substr(last + 1) != unit || !number) continue;
    const double value = *number * factor;
    if (value < 0 || value >= day) return std::nullopt;
    return std::chrono::microseconds{std::llround(value)};
  }
  return std::nullopt;
}

bool is_value_name(std::string_view text) {
  return !text.empty() && is_letter(text[0]) && std::all_of(text.begin(), text.end(), [](char c) {
    return is_letter(c) || is_digit(c) || c == '_';
  });
}

}  // namespace coupler::loader
