// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/spelling.hpp"

#include <iterator>

#include "coupler/base/lower.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::formats {
namespace {

/// Latin letters with accents, in Unicode's order from U+00C0 and from U+0100. '_' is a sign among them.
constexpr std::string_view of_00c0[] = {
    "a", "a", "a", "a", "ae", "a", "ae", "c", "e", "e", "e", "e", "i",  "i", "i",  "i",
    "d", "n", "o", "o", "o",  "o", "oe", "_", "o", "u", "u", "u", "ue", "y", "th", "ss",
    "a", "a", "a", "a", "ae", "a", "ae", "c", "e", "e", "e", "e", "i",  "i", "i",  "i",
    "d", "n", "o", "o", "o",  "o", "oe", "_", "o", "u", "u", "u", "ue", "y", "th", "y"};
constexpr std::string_view of_0100[] = {
    "a", "a", "a", "a", "a", "a", "c",  "c",  "c", "c", "c", "c", "c",  "c",  "d", "d", "d", "d", "e",
    "e", "e", "e", "e", "e", "e", "e",  "e",  "e", "g", "g", "g", "g",  "g",  "g", "g", "g", "h", "h",
    "h", "h", "i", "i", "i", "i", "i",  "i",  "i", "i", "i", "i", "ij", "ij", "j", "j", "k", "k", "k",
    "l", "l", "l", "l", "l", "l", "l",  "l",  "l", "l", "n", "n", "n",  "n",  "n", "n", "n", "n", "n",
    "o", "o", "o", "o", "o", "o", "oe", "oe", "r", "r", "r", "r", "r",  "r",  "s", "s", "s", "s", "s",
    "s", "s", "s", "t", "t", "t", "t",  "t",  "t", "u", "u", "u", "u",  "u",  "u", "u", "u", "u", "u",
    "u", "u", "w", "w", "y", "y", "y",  "z",  "z", "z", "z", "z", "z",  "s"};

/// Signs that stand between words, as a blank does: Latin-1's, and all from U+2000 to U+2BFF but letters.
bool is_sign(char32_t code) {
  return (code >= 0xA0 && code < 0xC0) || (code >= 0x2000 && code < 0x2C00) || code == 0xFEFF;
}

/// The letters for a character that is not ASCII's; nullopt if there are none.
std::optional<std::string_view> ascii_of(char32_t code) {
  switch (code) {
    case 0xAA: return "a";
    case 0xB2: return "2";
    case 0xB3: return "3";
    case 0xB5:
    case 0x3BC: return "u";  // micro
    case 0xB9: return "1";
    case 0xBA: return "o";
    case 0x218:
    case 0x219: return "s";
    case 0x21A:
    case 0x21B: return "t";
    case 0x1E9E: return "ss";
    default: break;
  }
  if (code >= 0xC0 && code - 0xC0 < std::size(of_00c0)) return of_00c0[code - 0xC0];
  if (code >= 0x100 && code - 0x100 < std::size(of_0100)) return of_0100[code - 0x100];
  if (is_sign(code)) return "_";
  return std::nullopt;
}

/// An accent that follows its letter, as macOS writes it.
bool is_accent(char32_t code) { return code >= 0x300 && code < 0x370; }
constexpr char32_t diaeresis = 0x308;

}  // namespace

std::optional<std::string> in_ascii(std::string_view name, std::string& unknown) {
  std::string out;
  for (std::size_t at = 0; at < name.size();) {
    const Character c = character_at(name, at);
    const std::string_view text = name.substr(at, c.size);
    at += c.size;
    const char last = out.empty() ? ' ' : out.back();
    if (c.code < 0x80) {
      out += lower(text);
    } else if (is_accent(c.code)) {
      if (c.code == diaeresis && (last == 'a' || last == 'o' || last == 'u')) out += 'e';
    } else if (const auto letters = ascii_of(c.code)) {
      out += *letters;
    } else {
      unknown = text;
      return std::nullopt;
    }
  }
  return out;
}

bool needs_spelling(std::string_view name) {
  for (std::size_t at = 0; at < name.size();) {
    const Character c = character_at(name, at);
    if (c.code >= 0x80 && ascii_of(c.code) != "_") return true;
    at += c.size;
  }
  return false;
}

}  // namespace coupler::formats
