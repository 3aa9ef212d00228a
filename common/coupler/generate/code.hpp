// SPDX-License-Identifier: Apache-2.0
// The map in the words of C++ and Python: literals, comments, names and values.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/fields.hpp"

namespace coupler::generate {

/// A C++ string literal, quotes included, that stands for exactly these bytes, whatever they are.
std::string literal(std::string_view text);

/// The same as adjacent literals, one per line of the text, each on its own line after `indent`; no newline
/// at the end.
std::string literal_lines(std::string_view text, std::string_view indent);

/// A str of Python, in one line of printable characters.
std::string python_literal(std::string_view text);

/// One line for a `//` comment: control characters become blanks, characters that turn the writing direction
/// (the compiler warns of them) go.
std::string comment(std::string_view text);

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

/// Letters, digits and underscores, a letter first.
bool is_name(std::string_view name);

/// It can name a namespace in generated code: is_name(), and no keyword.
bool is_identifier(std::string_view name);

/// "Table::coils"
template <class E>
std::string enumerator(E value) {
  return std::string(enumeration_of<E>.type).append("::").append(find_word(value)->name);
}

inline std::string code(std::string_view text) { return literal(text); }
/// The least one is an expression: C++ has no negative literals.
std::string code(std::int64_t value);
inline std::string code(std::chrono::milliseconds duration) { return fmt::format("{}ms", duration.count()); }
inline std::string code(std::chrono::microseconds duration) { return fmt::format("{}us", duration.count()); }
inline std::string code(std::chrono::nanoseconds duration) { return fmt::format("{}ns", duration.count()); }
template <class T>
std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>, std::string> code(T value) {
  if constexpr (std::is_enum_v<T>)
    return enumerator(value);
  else if constexpr (std::is_floating_point_v<T>)
    return codec::decimal(value);
  else
    return fmt::to_string(value);
}

template <class Struct>
std::string aggregate(const Struct& object);

/// "true, 3000ms, Poll::all": the values of its fields, in the order of fields_of().
template <class Struct>
std::string values_of(const Struct& object) {
  std::string out;
  for_each_field(object, [&](const auto&, const auto& value) {
    if (!out.empty()) out += ", ";
    if constexpr (has_fields<std::decay_t<decltype(value)>>)
      out += aggregate(value);
    else
      out += code(value);
  });
  return out;
}

/// "{true, 3000ms}", or "{}" if all have their defaults.
template <class Struct>
std::string aggregate(const Struct& object) {
  return has_defaults(object) ? "{}" : '{' + values_of(object) + '}';
}

/// "publish, deadband": the keys of its fields, in the same order.
template <class Struct>
std::string keys_of() {
  std::string out;
  const Struct object{};
  for_each_field(object, [&](const auto& field, const auto&) {
    if (!out.empty()) out += ", ";
    out += field.key;
  });
  return out;
}

}  // namespace coupler::generate
