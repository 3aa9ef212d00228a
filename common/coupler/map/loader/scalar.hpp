// SPDX-License-Identifier: Apache-2.0
// What the bare text of a scalar means. nullopt: it means nothing of that kind.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/base/lower.hpp"

namespace coupler::loader {

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Decimal, whatever zeros lead it ("00010" is 10, unlike in YAML 1.1), or hexadecimal as 0x1F. No sign.
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// The same, or a negative decimal number.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// A finite decimal number: "20", "-0.5", "1e3".
std::optional<double> parse_number(std::string_view text);

/// "true", "yes", "on" and their opposites as in YAML 1.1, in any case.
std::optional<bool> parse_boolean(std::string_view text);

/// A number and its unit, as "500us", "5ms", "1.5s" or "2min"; "0" needs none. Not negative, below 24 h.
std::optional<std::chrono::microseconds> parse_duration(std::string_view text);

/// It can be the name of a value: letters, digits and '_', a letter first.
bool is_value_name(std::string_view text);

}  // namespace coupler::loader
