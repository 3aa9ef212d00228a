// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/value_text.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/bit_string.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/map/published.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::host {
namespace {

using Parsed = tl::expected<void, std::string>;
using codec::Type;
using codec::Value;

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\n");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\n") - from + 1);
}

std::optional<bool> parse_bool(std::string_view text) {
  for (const std::string_view yes : {"true", "True", "on", "1"})
    if (text == yes) return true;
  for (const std::string_view no : {"false", "False", "off", "0"})
    if (text == no) return false;
  return std::nullopt;
}

/// The narrowest of int64, uint64 and double that holds it.
std::optional<Value> parse_number(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const bool hexadecimal = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
  char* end = nullptr;
  errno = 0;
  const long long whole = std::strtoll(text.c_str(), &end, hexadecimal ? 16 : 10);
  if (*end == '\0' && errno == 0) return Value{std::int64_t{whole}};
  errno = 0;
  const unsigned long long large = std::strtoull(text.c_str(), &end, hexadecimal ? 16 : 10);
  if (*end == '\0' && errno == 0 && text[0] != '-') return Value{std::uint64_t{large}};
  const double real = std::strtod(text.c_str(), &end);
  if (*end == '\0') return Value{real};
  return std::nullopt;
}

double as_double(const Value& number) {
  if (const auto* whole = std::get_if<std::int64_t>(&number)) return static_cast<double>(*whole);
  if (const auto* large = std::get_if<std::uint64_t>(&number)) return static_cast<double>(*large);
  return std::get<double>(number);
}

/// `wrong` is empty if nothing is.
Parsed done_or(std::string wrong) {
  if (wrong.empty()) return {};
  return tl::make_unexpected(std::move(wrong));
}

Parsed parse_element(std::string_view text, const Point& point, std::uint16_t* registers) {
  const codec::Format& format = point.format;
  if (format.type == Type::STRING) return done_or(encode_string(text, point, registers));
  text = trimmed(text);
  registers[0] = 0;
  if (format.type == Type::BOOL) {
    const auto on = parse_bool(text);
    if (!on)
      return tl::make_unexpected(excerpt(text) +
                                 " is neither true nor false; send true or false (or on, off, 1, 0)");
    if (!holds_bits(point.table)) return codec::encode(*on, format, registers);
    registers[0] = *on ? 1 : 0;
    return {};
  }
  for (const NamedValue& named : point.values)
    if (text == named.name) return codec::encode(named.value, format, registers);
  const auto number = parse_number(std::string(text));
  if (!number && !point.values.empty())
    return tl::make_unexpected(
        fmt::format("{} is not one of its values; send {}", excerpt(text), allowed_text(point)));
  if (!number)
    return tl::make_unexpected(
        fmt::format("{} is not a number; send {}", excerpt(text),
                    limits_values(point) ? allowed_text(point) : "one, as 4711, 0x2F or -1.5"));
  if (point.scale.present()) return done_or(encode_scaled(as_double(*number), point, registers));
  auto encoded = codec::encode(*number, format, registers);
  if (!encoded && limits_values(point))  // the range of the type is not what may be sent
    return tl::make_unexpected(fmt::format("{} is not allowed; send {}", excerpt(text), allowed_text(point)));
  return encoded;
}

std::vector<std::string_view> elements(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '[' && text.back() == ']') text = text.substr(1, text.size() - 2);
  std::vector<std::string_view> result;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    result.push_back(text.substr(from, comma - from));
    from = comma + 1;
  }
  return result;
}

/// 217 x 0.1 is 21.7 to a person, not 21.700000000000003: the last digits only where they tell values apart.
std::string scaled_text(const std::uint16_t* registers, const Point& point) {
  const codec::Scale scale = scale_of(registers, point);
  const double value = codec::published(registers, point.format, scale);
  const std::string text = fmt::format("{:.15g}", value);
  std::array<std::uint16_t, 4> again{};  // no type with a scale is longer
  const std::size_t count = codec::registers(point.format);
  std::copy_n(registers, count, again.begin());
  const double shown = std::strtod(text.c_str(), nullptr);
  const bool same =
      codec::encode_published(shown, point.format, scale, again.data()) == codec::ScaleError::none &&
      std::equal(registers, registers + count, again.begin());
  return same ? text : fmt::format("{}", value);
}

}  // namespace

Parsed parse_value(std::string_view text, const Point& point, std::uint16_t* registers) {
  if (point.count == 1) return parse_element(text, point, registers);
  const auto list = elements(text);
  if (list.size() != point.count)
    return tl::make_unexpected(
        fmt::format("{} elements; give {}, as in [1, 2, 3]", list.size(), point.count));
  for (const std::string_view element : list) {
    if (auto done = parse_element(element, point, registers); !done) return done;
    registers += codec::registers(point.format);
  }
  return {};
}

std::string format_value(const std::uint16_t* registers, const Point& point) {
  const auto one = [&](const std::uint16_t* at) -> std::string {
    if (holds_bits(point.table)) return at[0] != 0 ? "true" : "false";
    if (point.scale.present()) return scaled_text(at, point);
    if (const auto name = name_of_value(point, at); !name.empty()) return std::string(name);
    return codec::text_of(codec::decode(at, point.format), point.format.type);
  };
  if (point.count == 1) return one(registers);
  std::string list;
  for (std::size_t i = 0; i < point.count; ++i, registers += codec::registers(point.format))
    list += (i > 0 ? ", " : "") + one(registers);
  return "[" + list + "]";
}

std::string unusable_text(const std::uint16_t* registers, const Point& point) {
  if (point.format.type == Type::BOOL) return "the device gives a register that the map calls invalid";
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i, registers += width) {
    const std::string which = point.count > 1 ? fmt::format(" as element {}", i) : "";
    if (is_invalid_element(point, registers))
      return fmt::format("the device gives 0x{:0{}X}{}, which the map calls invalid",
                         raw_value(point.format, registers), codec::width(point.format.type) / 4, which);
    const double raw = codec::published(registers, point.format, {});
    if (point.faults.is_below(raw))
      return fmt::format("the device gives {:.15g}{}, below fault_below ({:.15g})", raw, which,
                         point.faults.below);
    if (point.faults.is_above(raw))
      return fmt::format("the device gives {:.15g}{}, above fault_above ({:.15g})", raw, which,
                         point.faults.above);
  }
  return {};
}

}  // namespace coupler::host
