// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "coupler/base/shortened.hpp"
#include "coupler/codec/number.hpp"
#include "coupler/codec/text.hpp"

namespace coupler::codec {
namespace {

using Result = tl::expected<void, std::string>;

template <class T>
Value widen(T value) {
  if constexpr (std::is_floating_point_v<T>)
    return value;
  else if constexpr (std::is_signed_v<T>)
    return std::int64_t{value};
  else
    return std::uint64_t{value};
}

template <class To>
tl::unexpected<std::string> out_of_range(const Value& value, Type type) {
  if constexpr (std::is_floating_point_v<To>)
    return tl::make_unexpected(fmt::format("{} does not fit into {}", to_string(value), to_string(type)));
  else
    return tl::make_unexpected(fmt::format("{} does not fit into {} ({} to {})", to_string(value),
                                           to_string(type), +std::numeric_limits<To>::min(),
                                           +std::numeric_limits<To>::max()));
}

/// From here on a double is no float. What is below rounds to the largest, as 3.4028235e38 does, its shortest
/// text.
constexpr double rounds_to_infinity = 0x1.ffffffp127;

/// A double that rounds to the largest float is above it, which the language leaves undefined.
template <class To, class From>
To converted(From from) {
  if constexpr (std::is_same_v<To, float> && std::is_same_v<From, double>)
    if (std::isfinite(from)) {
      constexpr double most = std::numeric_limits<float>::max();
      return static_cast<float>(std::clamp(from, -most, most));
    }
  return static_cast<To>(from);
}

template <class To, class From>
bool fits(From from) {
  if constexpr (std::is_floating_point_v<To>) {
    if constexpr (std::is_same_v<From, double> && std::is_same_v<To, float>)
      return !std::isfinite(from) || std::fabs(from) < rounds_to_infinity;
    return true;
  } else if constexpr (std::is_floating_point_v<From>) {  // the largest may have no double, one more has
    return from >= static_cast<From>(std::numeric_limits<To>::min()) &&
           from < std::ldexp(From{1}, std::numeric_limits<To>::digits);
  } else if constexpr (std::is_signed_v<From>) {
    if constexpr (std::is_signed_v<To>)
      return from >= std::numeric_limits<To>::min() && from <= std::numeric_limits<To>::max();
    else
      return from >= 0 && static_cast<std::uint64_t>(from) <= std::numeric_limits<To>::max();
  } else {
    return from <= static_cast<std::uint64_t>(std::numeric_limits<To>::max());
  }
}

/// Callers may want long texts written.
constexpr std::size_t most_quoted = 300;  // a STRING has 250 bytes at most

template <class To>
Result put_number(const Value& value, const Format& format, std::uint16_t* registers) {
  return std::visit(
      [&](const auto& v) -> Result {
        using From = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<From, bool> || std::is_same_v<From, std::string>) {
          return tl::make_unexpected(
              fmt::format("'{}' is not a number", shortened(to_string(value), most_quoted)));
        } else {
          if constexpr (std::is_floating_point_v<From> && !std::is_floating_point_v<To>)
            if (v != std::trunc(v))
              return tl::make_unexpected(
                  fmt::format("{} is not a whole number, as {} needs", v, to_string(format.type)));
          if (!fits<To>(v)) return out_of_range<To>(value, format.type);
          if (!has_room(converted<To>(v), format))
            return tl::make_unexpected(fmt::format("{} does not fit into {} bits (0 to {})", to_string(value),
                                                   format.bits, largest_in(format.bits)));
          put(converted<To>(v), format, registers);
          return {};
        }
      },
      value);
}

Result put_text(const Value& value, const Format& format, std::uint16_t* registers) {
  const auto* text = std::get_if<std::string>(&value);
  if (text == nullptr) return tl::make_unexpected(fmt::format("{} is not text", to_string(value)));
  switch (encode_text(*text, format, registers)) {
    case TextError::too_long:
      return tl::make_unexpected(
          fmt::format("'{}' is longer than {} bytes", shortened(*text, most_quoted), format.length));
    case TextError::not_encodable:
      return tl::make_unexpected(fmt::format("'{}' cannot be written in {}", shortened(*text, most_quoted),
                                             to_string(format.encoding)));
    case TextError::has_nul:
      return tl::make_unexpected(
          std::string("a text with a NUL character cannot be written, since it would end there"));
    case TextError::none: break;
  }
  return {};
}

/// The digits come from fmt: the fewest that do. Where it puts the point, and when it writes an exponent,
/// differs from release to release.
template <class T>
std::string shortest(T value) {
  const std::string text = fmt::format("{}", std::fabs(value));
  const std::size_t e = std::min(text.find('e'), text.size());
  const std::string mantissa = text.substr(0, e);
  const auto whole = static_cast<int>(std::min(mantissa.find('.'), mantissa.size()));
  std::string digits = mantissa;
  digits.erase(std::remove(digits.begin(), digits.end(), '.'), digits.end());
  const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size());
  // 0.digits × 10^exponent
  int exponent = whole - static_cast<int>(first);
  if (e < text.size()) exponent += std::atoi(text.c_str() + e + 1);
  digits.erase(0, first);
  digits.erase(digits.find_last_not_of('0') + 1);
  const std::string sign = std::signbit(value) ? "-" : "";
  if (digits.empty()) return sign + "0.0";
  const auto count = static_cast<int>(digits.size());
  if (exponent > 16 || exponent < -4)
    return fmt::format("{}{}.{}e{}", sign, digits[0], count > 1 ? digits.substr(1) : "0", exponent - 1);
  if (exponent <= 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent), '0') + digits;
  if (count <= exponent) return sign + digits.append(static_cast<std::size_t>(exponent - count), '0') + ".0";
  return sign + digits.insert(static_cast<std::size_t>(exponent), ".");
}

}  // namespace

Value decode(const std::uint16_t* registers, const Format& format) {
  if (format.type == Type::BOOL) return decode_part(registers[0], format) != 0;
  if (format.type == Type::STRING) {
    std::string text;
    decode_text(registers, format, text);
    return text;
  }
  return with_number(format.type,
                     [&](auto zero) -> Value { return widen(take<decltype(zero)>(format, registers)); });
}

Result encode(const Value& value, const Format& format, std::uint16_t* registers) {
  if (format.type == Type::STRING) return put_text(value, format, registers);
  if (format.type == Type::BOOL) {
    const bool* on = std::get_if<bool>(&value);
    if (on == nullptr)
      return tl::make_unexpected(fmt::format("{} is neither true nor false", to_string(value)));
    put(static_cast<std::uint8_t>(*on), format, registers);
    return {};
  }
  return with_number(format.type,
                     [&](auto zero) { return put_number<decltype(zero)>(value, format, registers); });
}

std::string to_string(const Value& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::string>)
          return v;
        else
          return fmt::format("{}", v);
      },
      value);
}

std::string decimal(double value) { return shortest(value); }
std::string decimal(float value) { return shortest(value); }

}  // namespace coupler::codec
