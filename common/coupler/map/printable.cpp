// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/printable.hpp"

#include <array>
#include <cstdint>

#include <fmt/format.h>

#include "coupler/base/shortened.hpp"

namespace coupler {
namespace {

std::uint8_t byte(std::string_view text, std::size_t i) { return static_cast<std::uint8_t>(text[i]); }

/// `kept`: control characters that stay.
std::string escaped(std::string_view text, std::string_view kept) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    const bool stays = c.size == 1 && kept.find(text[at]) != std::string_view::npos;
    if (!c.valid || (is_control(c.code) && !stays))
      out += fmt::format("\\x{:02x}", static_cast<unsigned>(c.code));
    else if (turns_direction(c.code))
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c.code));
    else
      out += text.substr(at, c.size);
    at += c.size;
  }
  return out;
}

}  // namespace

Character character_at(std::string_view text, std::size_t at) {
  const std::uint8_t first = byte(text, at);
  if (first < 0x80) return {first, 1};
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || at + size > text.size()) return {first, 1, false};
  char32_t code = first & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(text, at + i) & 0xC0U) != 0x80U) return {first, 1, false};
    code = code << 6U | (byte(text, at + i) & 0x3FU);
  }
  constexpr std::array<char32_t, 3> least{0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (code < least[size - 2] || surrogate || code > 0x10FFFF) return {first, 1, false};
  return {code, size};
}

bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

bool turns_direction(char32_t code) {
  return code == 0x200E || code == 0x200F || (code >= 0x202A && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

std::string printable(std::string_view text) { return escaped(text, ""); }

std::string excerpt(std::string_view text) {
  constexpr std::size_t most = 80;
  const std::string size = text.size() > most ? fmt::format(" ({} bytes)", text.size()) : "";
  return fmt::format("'{}'{}", printable(shortened(text, most)), size);
}

std::string printable_lines(std::string_view text) { return escaped(text, "\n\t"); }

}  // namespace coupler
