// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/syntax.hpp"

#include <algorithm>
#include <array>

#include "coupler/map/loader/json_comments.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {
namespace {

struct Explanation {
  std::string_view message;  ///< how yaml-cpp's begins
  std::string_view what;
  std::string_view remedy;
};

constexpr std::array<Explanation, 13> explanations{{
    {"end of map flow not found", "',' or '}' is missing before this",
     "separate entries with ',' and end them with '}'"},
    {"end of sequence flow not found", "',' or ']' is missing before this",
     "separate values with ',' and end them with ']'"},
    {"end of map not found", "this does not belong to the entries above",
     "check the indentation, and what follows a closing quote"},
    {"end of sequence not found", "this does not belong to the list above", "check the indentation"},
    {"illegal map value", "':' does not belong here",
     "write 'key: value' here and in the line before, at one indentation; put text that contains ': ' in "
     "quotes"},
    {"illegal map key", "a key does not belong here",
     "write one 'key: value' a line, all at one indentation"},
    {"illegal block entry", "'- ' does not belong here", "begin the list in the line below its key"},
    {"illegal flow end", "the bracket has no opening one", "remove it, or open it before"},
    {"unknown token", "no value begins with this character", "put the text in quotes"},
    {"unknown escape character", "the escape is not known",
     "write '\\\\' for a backslash, or use single quotes"},
    {"invalid unicode", "the escape stands for no character (half of a surrogate pair)",
     "write the character itself"},
    {"the referenced anchor is not defined", "aliases are not supported",
     "write the values out where they are used"},
    {"bad file", "the values are nested too deep", "a map has at most five levels"},
}};

/// Tabs where YAML counts blanks.
bool indented_by_tab(std::string_view text, std::size_t offset) {
  const std::size_t newline = text.substr(0, offset).rfind('\n');
  const std::size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  const std::size_t first = text.find_first_not_of(" \t", start);
  const std::size_t tab = text.find('\t', start);
  return tab != std::string_view::npos && tab < std::min(first, text.size());
}

}  // namespace

std::size_t quoted_end(std::string_view text, std::size_t at) {
  const char quote = at < text.size() ? text[at] : '\0';
  if (quote != '"' && quote != '\'') return at;
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote == '"' || text.substr(i + 1, 1) != "'") return i + 1;
      ++i;  // '' is an apostrophe
    }
  }
  return std::string_view::npos;
}

bool has_colon(std::string_view text, std::size_t at, std::string_view key) {
  const std::size_t quoted = quoted_end(text, at);
  const std::size_t end = quoted == at ? at + key.size() : quoted;
  const std::size_t next = text.find_first_not_of(" \t\r\n", end);
  return next != std::string_view::npos && text[next] == ':';
}

std::optional<std::size_t> missing_comma(std::size_t at, std::string_view bare_text) {
  const std::size_t blank = bare_text.find_first_of(" \t\n");
  if (blank == std::string_view::npos) return std::nullopt;
  return at + blank;
}

SyntaxError explain(std::string_view text, std::size_t offset, std::string_view message) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  if (last == std::string_view::npos || offset > last) {
    const Position end = position_of(text, last == std::string_view::npos ? 0 : last + 1);
    return {end, "the file ends too early", "close what is open: a '}', a ']' or a quote"};
  }
  const Position at = position_of(text, offset);
  if (!is_json(text) && indented_by_tab(text, offset))
    return {at, "the line is indented by a tab", "indent with blanks"};
  for (const Explanation& known : explanations)
    if (message.substr(0, known.message.size()) == known.message)
      return {at, std::string(known.what), std::string(known.remedy)};
  return {at, std::string(message), "write it as YAML or JSON"};
}

}  // namespace coupler::loader
