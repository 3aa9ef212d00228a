// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/code.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "coupler/map/escape.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::generate {
namespace {

std::string escape(char c) {
  switch (c) {
    case '\n': return "\\n";
    case '\r': return "\\r";
    case '\t': return "\\t";
    case '"': return "\\\"";
    case '\\': return "\\\\";
    default: break;
  }
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x20 && byte < 0x7F) return std::string(1, c);
  return fmt::format("\\{:03o}", byte);  // three digits always: a digit that follows stays text
}

// The keywords of C++20 and the alternative tokens ([lex.key], [lex.digraph]); and std, since a namespace
// coupler::maps::std would hide the real one.
constexpr std::string_view keywords[] = {
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
    "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "std",      "struct",     "switch",    "template",  "this",         "thread_local",
    "throw",       "true",     "try",        "typedef",   "typeid",    "typename",     "union",
    "unsigned",    "using",    "virtual",    "void",      "volatile",  "wchar_t",      "while",
    "xor",         "xor_eq"};

}  // namespace

std::string literal(std::string_view text) {
  std::string out = "\"";
  char before = '\0';
  for (const char c : text) {
    if (c == '?' && before == '?') out += '\\';  // "??/" would be a trigraph
    out += escape(c);
    before = c;
  }
  return out + '"';
}

std::string literal_lines(std::string_view text, std::string_view indent) {
  std::string out;
  do {
    const std::size_t end = text.find('\n');
    const std::size_t length = end == std::string_view::npos ? text.size() : end + 1;
    if (!out.empty()) out += '\n';
    out.append(indent).append(literal(text.substr(0, length)));
    text.remove_prefix(length);
  } while (!text.empty());
  return out;
}

std::string python_literal(std::string_view text) {
  return double_quoted(text, [](const Character& c, std::string_view /*bytes*/) {
    const bool is_shown = c.valid && !is_control(c.code) && !turns_direction(c.code);
    return is_shown ? std::string() : fmt::format("\\U{:08x}", static_cast<std::uint32_t>(c.code));
  });
}

std::string comment(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (c.valid && is_control(c.code))
      out += ' ';
    else if (!turns_direction(c.code))
      out += text.substr(at, c.size);
    at += c.size;
  }
  return out;
}

std::string code(std::int64_t value) {
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  return value == least ? fmt::format("{} - 1", least + 1) : fmt::to_string(value);
}

bool is_name(std::string_view name) {
  return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), is_name_character);
}

bool is_identifier(std::string_view name) {
  return is_name(name) && !std::binary_search(std::begin(keywords), std::end(keywords), name);
}

}  // namespace coupler::generate
