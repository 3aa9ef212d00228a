// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_names.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;
using loader::shown;

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

/// The first character for which there are no letters is in `unknown`.
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

/// A name with signs alone, such as "Temp °C", keeps its capital letters.
bool needs_spelling(std::string_view name) {
  for (std::size_t at = 0; at < name.size();) {
    const Character c = character_at(name, at);
    if (c.code >= 0x80 && ascii_of(c.code) != "_") return true;
    at += c.size;
  }
  return false;
}

bool has_letter(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

/// Returns false, with an error, if the name cannot be spelt.
bool spell(Entry& point, Problems& problems) {
  std::string unknown;
  const auto spelt = in_ascii(point.key, unknown);
  if (!spelt || !has_letter(*spelt)) {
    problems.error(point.key_at,
                   spelt ? fmt::format("the name {} has no letter from a to z", shown(point.key))
                         : fmt::format("the name {} has {}, which has no spelling in the letters a to z",
                                       shown(point.key), shown(unknown)),
                   "give the point a name of a to z, digits and '_'; this one may be its description");
    return false;
  }
  std::string name = mended_name(*spelt, "point");
  if (loader::child(point, "description") == nullptr)
    point.children.push_back(scalar("description", point.key, point.key_at, true));
  problems.warning(
      point.key_at,
      fmt::format("{} is not a valid name of a point and was changed to '{}'", shown(point.key), name),
      "change it in the map if you prefer another name");
  point.key = std::move(name);
  return true;
}

struct Named {
  std::string given;
  loader::Position at;
  bool was_spelt = false;
};

void spell_names_of(Entry& mapping, Problems& problems) {
  std::unordered_map<std::string, Named> names;
  for (Entry& table : mapping.children)
    for (Entry& point : table.children) {
      Named named{point.key, point.key_at, needs_spelling(point.key)};
      if (named.was_spelt && !spell(point, problems)) {
        point.key = fmt::format("point_of_line_{}", point.key_at.line);  // nothing more is told of it
        continue;
      }
      const auto [other, is_first] = names.emplace(lower(mended_name(point.key, "point")), named);
      if (is_first || (!named.was_spelt && !other->second.was_spelt)) continue;
      problems.error(named.at,
                     fmt::format("{} and {} in line {} would both be called '{}'", shown(named.given),
                                 shown(other->second.given), other->second.at.line, other->first),
                     "give one of the two another name", {{other->second.at, "the other is here"}});
      point.key = fmt::format("point_of_line_{}", point.key_at.line);
    }
}

}  // namespace

void spell_names(std::vector<ForeignUnit>& units, Problems& problems) {
  for (ForeignUnit& unit : units)
    if (Entry* mapping = find(unit.map, "mapping")) spell_names_of(*mapping, problems);
}

}  // namespace coupler::formats
