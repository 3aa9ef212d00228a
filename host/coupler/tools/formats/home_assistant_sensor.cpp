// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/home_assistant_sensor.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"

namespace coupler::formats {
namespace {

using codec::Type;

constexpr int float_decimals = 6;

std::string_view data_type_of(Type type) {
  switch (type) {
    case Type::INT: return "int16";
    case Type::WORD:
    case Type::UINT: return "uint16";
    case Type::DINT: return "int32";
    case Type::DWORD:
    case Type::UDINT: return "uint32";
    case Type::LINT: return "int64";
    case Type::LWORD:
    case Type::ULINT: return "uint64";
    case Type::REAL: return "float32";
    case Type::LREAL: return "float64";
    case Type::STRING: return "string";
    default: return "custom";  // bytes
  }
}

std::string_view swap_of(const codec::Format& format) {
  const bool bytes = codec::bytes_swapped(format.order);
  if (codec::words_reversed(format.order)) return bytes ? "word_byte" : "word";
  return bytes ? "byte" : "";
}

/// Decimals of the shortest text of the number: 0.25 has two.
int decimals_of(double number) {
  const std::string shown = fmt::format("{}", number);
  const std::size_t exponent = shown.find("e-");
  const std::size_t point = shown.find('.');
  const std::size_t digits_end = std::min(exponent, shown.size());
  int decimals = point == std::string::npos ? 0 : static_cast<int>(digits_end - point - 1);
  if (exponent != std::string::npos) decimals += std::stoi(shown.substr(exponent + 2));
  return std::min(decimals, 15);
}

}  // namespace

std::string format_keys(const Point& point, std::string_view indent) {
  const codec::Format& format = point.format;
  std::string keys = fmt::format("{}data_type: {}\n", indent, data_type_of(format.type));
  if (codec::width(format.type) == 8) {
    // The byte as it stands on the wire, so nothing is to be swapped.
    const char letter = format.type == Type::SINT ? 'b' : 'B';
    keys += fmt::format(
        "{}count: 1\n{}structure: \"{}\"\n", indent, indent,
        codec::mask(format) == 0xFF00 ? fmt::format(">{}x", letter) : fmt::format(">x{}", letter));
    return keys + (point.scale.present()
                       ? fmt::format("{}precision: {}\n", indent,
                                     std::max(decimals_of(point.scale.gain), decimals_of(point.scale.offset)))
                       : fmt::format("{}precision: 0\n", indent));
  }
  if (format.type == Type::STRING) keys += fmt::format("{}count: {}\n", indent, codec::registers(format));
  if (const std::string_view swap = swap_of(format); !swap.empty())
    keys += fmt::format("{}swap: {}\n", indent, swap);
  if (is_float(format.type))
    keys += fmt::format("{}precision: {}\n", indent, float_decimals);
  else if (point.scale.present())
    keys += fmt::format("{}precision: {}\n", indent,
                        std::max(decimals_of(point.scale.gain), decimals_of(point.scale.offset)));
  return keys;
}

std::optional<std::int64_t> nan_value_of(const Point& point) {
  const Type type = point.format.type;
  const bool is_one = point.invalid.size() == 1 && point.invalid[0].first == point.invalid[0].last;
  if (!is_one || !codec::is_scalable(type) || is_float(type)) return std::nullopt;
  return codec::with_number(type, [&](auto zero) -> std::optional<std::int64_t> {
    using T = decltype(zero);
    const T none = static_cast<T>(point.invalid[0].first);
    if constexpr (std::is_same_v<T, std::uint64_t>)
      return std::nullopt;
    else if (std::is_unsigned_v<T> || none == std::numeric_limits<T>::lowest() || none == 0)
      return static_cast<std::int64_t>(none);
    return std::nullopt;
  });
}

}  // namespace coupler::formats
