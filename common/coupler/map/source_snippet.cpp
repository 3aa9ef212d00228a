// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/source_snippet.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "coupler/map/printable.hpp"

namespace coupler {
namespace {

constexpr std::size_t most_before = 80;  // bytes
constexpr std::size_t most_after = 60;
constexpr std::string_view cut = "...";

std::uint8_t byte(std::string_view text, std::size_t i) { return static_cast<std::uint8_t>(text[i]); }
bool continues(std::uint8_t byte) { return (byte & 0xC0U) == 0x80U; }

/// Columns of a terminal: none for what combines with its neighbour, two for the wide scripts and pictures.
std::size_t width(char32_t code) {
  struct Span {
    char32_t first, last;
  };
  constexpr std::array<Span, 4> none{{{0x300, 0x36F}, {0x200B, 0x200F}, {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF}}};
  constexpr std::array<Span, 7> two{{{0x1100, 0x115F},
                                     {0x2E80, 0xA4CF},
                                     {0xAC00, 0xD7A3},
                                     {0xF900, 0xFAFF},
                                     {0xFF00, 0xFF60},
                                     {0x1F300, 0x1FAFF},
                                     {0x20000, 0x3FFFD}}};
  const auto holds = [code](const Span& span) { return code >= span.first && code <= span.last; };
  if (std::any_of(none.begin(), none.end(), holds)) return 0;
  return std::any_of(two.begin(), two.end(), holds) ? 2 : 1;
}

/// Byte by byte the same length, so that columns stay what they are.
std::string showable(std::string_view line) {
  std::string text;
  for (std::size_t i = 0; i < line.size();) {
    const Character c = character_at(line, i);
    if (!c.valid || (is_control(c.code) && c.code != '\t') || turns_direction(c.code))
      text.append(c.size, c.valid ? ' ' : '?');
    else
      text += line.substr(i, c.size);
    i += c.size;
  }
  return text;
}

bool in_word(std::string_view text, std::size_t at) {
  const std::uint8_t c = byte(text, at);
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/' ||
         c >= 0x80;
}

}  // namespace

SourceSnippet snippet(std::string_view line, int column) {
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(column, 1) - 1), line.size());
  std::size_t begin = at > most_before ? at - most_before : 0;
  std::size_t end = std::min(line.size(), at + most_after);
  while (begin < at && begin > 0 && continues(byte(line, begin))) ++begin;
  while (end < line.size() && continues(byte(line, end))) ++end;
  SourceSnippet shown{showable(line.substr(begin, end - begin)), at - begin};
  if (end < line.size()) shown.text += cut;
  if (begin == 0) return shown;
  shown.text.insert(0, cut);
  shown.caret += cut.size();
  return shown;
}

std::string underline(const SourceSnippet& snippet) {
  const std::string_view text = snippet.text;
  std::string below;
  for (std::size_t i = 0; i < snippet.caret;) {
    const Character c = character_at(text, i);
    below.append(c.code == '\t' ? 1 : width(c.code), c.code == '\t' ? '\t' : ' ');
    i += c.size;
  }
  below += '^';
  if (snippet.caret >= text.size()) return below;
  std::size_t columns = 0;
  for (std::size_t i = snippet.caret; i < text.size() && in_word(text, i);) {
    const Character c = character_at(text, i);
    columns += width(c.code);
    i += c.size;
  }
  if (columns > 1) below.append(columns - 1, '~');
  return below;
}

}  // namespace coupler
