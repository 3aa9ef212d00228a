// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/syntax_error.hpp"

#include <algorithm>
#include <array>

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
    {"unknown token", "no value begins with this character",
     "put a text in quotes; an address is a number, without '%' and letters"},
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

/// A quote opens a string where a value or key can begin.
bool begins_value(char previous) {
  return std::string_view("{[,:-\n").find(previous) != std::string_view::npos;
}

/// The comment that begins at `at`; empty if none does.
std::string_view comment_at(std::string_view text, std::size_t at) {
  const bool begins =
      text[at] == '#' && (at == 0 || std::string_view(" \t\n").find(text[at - 1]) != std::string_view::npos);
  return begins ? text.substr(at, std::min(text.find('\n', at), text.size()) - at) : std::string_view{};
}

/// The comment has more brackets that close `open` than ones like it.
bool closes(std::string_view comment, char open) {
  return std::count(comment.begin(), comment.end(), open == '{' ? '}' : ']') >
         std::count(comment.begin(), comment.end(), open);
}

/// Returns the place before `offset` at which a comment hides the only bracket that closes another one, so
/// that the rest of the file makes no sense: '#' after a blank begins a comment inside brackets, too. Returns
/// npos if there is none.
std::size_t hiding_comment(std::string_view text, std::size_t offset) {
  std::string open;  // brackets
  std::size_t found = std::string_view::npos;
  std::size_t depth = 0;  // of the brackets there
  char previous = '\n';
  for (std::size_t i = 0; i < std::min(text.size(), offset); ++i) {
    const char c = text[i];
    const std::string_view comment = comment_at(text, i);
    const std::size_t quoted = begins_value(previous) ? quoted_end(text, i) : i;
    if (quoted == std::string_view::npos) break;
    if (found == std::string_view::npos && !open.empty() && closes(comment, open.back())) {
      found = i;
      depth = open.size();
    }
    if (c == '{' || c == '[') open += c;
    if ((c == '}' || c == ']') && !open.empty()) open.pop_back();
    if (open.size() < depth) found = std::string_view::npos;
    if (c != ' ' && c != '\t') previous = c;
    i = std::max({i + 1, quoted, i + comment.size()}) - 1;
  }
  return found;
}

}  // namespace

SyntaxError explain(std::string_view text, std::size_t offset, std::string_view message) {
  if (const std::size_t hash = hiding_comment(text, offset); hash != std::string_view::npos)
    return {position_of(text, hash), "'#' begins a comment, which hides the closing bracket behind it",
            "close the bracket before the '#', or put text that contains ' #' in quotes"};
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
