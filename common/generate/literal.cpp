// SPDX-License-Identifier: Apache-2.0
#include "common/generate/literal.hpp"

#include <fmt/format.h>

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

/// U+200E, U+200F, U+202A … U+202E, U+2066 … U+2069 in UTF-8.
bool turns_direction(std::string_view at) {
  if (at.size() < 3 || at[0] != '\xE2') return false;
  const auto third = static_cast<unsigned char>(at[2]);
  if (at[1] == '\x80') return third == 0x8E || third == 0x8F || (third >= 0xAA && third <= 0xAE);
  return at[1] == '\x81' && third >= 0xA6 && third <= 0xA9;
}

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

std::string comment(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (turns_direction(text.substr(i))) {
      i += 2;
      continue;
    }
    const auto byte = static_cast<unsigned char>(text[i]);
    out += byte < 0x20 || byte == 0x7F ? ' ' : text[i];
  }
  return out;
}

}  // namespace coupler::generate
