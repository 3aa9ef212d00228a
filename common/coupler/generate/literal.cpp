// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/literal.hpp"

#include <fmt/format.h>

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

}  // namespace coupler::generate
