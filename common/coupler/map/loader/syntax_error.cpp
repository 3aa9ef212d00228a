// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/syntax_error.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/line_error.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {
namespace {

struct Explanation {
  std::string_view message;  ///< how yaml-cpp's begins
  std::string_view what;
  std::string_view remedy;
};

constexpr std::array<Explanation, 12> explanations{{
    {"end of map flow not found", "',' or '}' is missing before this",
     "separate entries with ',' and end them with '}'; put text that contains ': ' in quotes"},
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

/// The text before a place that a parser rejects.
struct Before {
  std::vector<std::size_t> open;  ///< brackets
  /// The comment that hides the only bracket that closes another one: '#' after a blank begins a comment
  /// inside brackets, too.
  std::size_t hiding_comment = std::string_view::npos;
  std::size_t quote = 0;  ///< the last text in quotes
  std::size_t quote_end = 0;
};

Before look_before(std::string_view text, std::size_t offset) {
  Before found;
  std::size_t& hiding = found.hiding_comment;
  std::size_t depth = 0;  // of the brackets there
  char previous = '\n';
  for (std::size_t i = 0; i < std::min(text.size(), offset); ++i) {
    const char c = text[i];
    const std::string_view comment = comment_at(text, i);
    const std::size_t quoted = begins_value(previous) ? quoted_end(text, i) : i;
    if (quoted == std::string_view::npos) break;
    if (hiding == std::string_view::npos && !found.open.empty() && closes(comment, text[found.open.back()])) {
      hiding = i;
      depth = found.open.size();
    }
    if (quoted != i) found.quote = i, found.quote_end = quoted;
    if (c == '{' || c == '[') found.open.push_back(i);
    if ((c == '}' || c == ']') && !found.open.empty()) found.open.pop_back();
    if (found.open.size() < depth) hiding = std::string_view::npos;
    if (c != ' ' && c != '\t') previous = c;
    i = std::max({i + 1, quoted, i + comment.size()}) - 1;
  }
  return found;
}

char closing(char open) { return open == '{' ? '}' : ']'; }

SyntaxError never_closed(std::string_view text, std::size_t open) {
  return {position_of(text, open), fmt::format("the '{}' is never closed", text[open]),
          fmt::format("close it with '{}'", closing(text[open]))};
}

std::size_t indentation(std::string_view text, std::size_t offset) {
  const std::size_t newline = text.substr(0, offset).rfind('\n');
  const std::size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  return std::min(text.find_first_not_of(' ', start), text.size()) - start;
}

/// Only blanks are between the quote and `offset`, and no entry begins there that lacks a ',' before it.
bool is_text_behind_quote(std::string_view text, std::size_t offset, std::size_t quote_end) {
  const std::size_t next = text.find_first_not_of(" \t", quote_end);
  const std::size_t entry_end = text.find_first_of(":,{}[]\n", offset);
  return quote_end == offset ||
         (next == offset && (entry_end == std::string_view::npos || text[entry_end] != ':'));
}

/// Returns what is wrong before a place in brackets where the parser expected ',' or a closing bracket.
std::optional<SyntaxError> explain_in_brackets(std::string_view text, std::size_t offset,
                                               const Before& before) {
  const int line = position_of(text, offset).line;
  const bool ends_here = before.quote_end > 0 && position_of(text, before.quote_end).line == line;
  if (ends_here && position_of(text, before.quote).line < line)
    return SyntaxError{position_of(text, before.quote), "the quote is not closed in its line",
                       "close it where the text ends"};
  if (ends_here && is_text_behind_quote(text, offset, before.quote_end))
    return text_behind(text[before.quote], text, offset);
  if (before.open.empty() || is_json(text)) return std::nullopt;
  const std::size_t open = before.open.back();
  if (position_of(text, open).line < line && indentation(text, offset) <= indentation(text, open))
    return never_closed(text, open);
  return std::nullopt;
}

/// The bracket at `offset` closes another one than the last that was opened.
SyntaxError wrong_bracket(std::string_view text, std::size_t offset, std::size_t open) {
  return {position_of(text, offset),
          fmt::format("'{}' is missing before this: '{}' of line {} is open", closing(text[open]), text[open],
                      position_of(text, open).line),
          fmt::format("close it with '{}'", closing(text[open]))};
}

/// The word before the ':' before `offset`; empty if none stands there.
std::string_view key_before(std::string_view text, std::size_t offset) {
  const std::size_t colon = text.find_last_not_of(" \t", offset - 1);
  if (offset == 0 || colon == std::string_view::npos || text[colon] != ':') return {};
  const std::size_t before = text.substr(0, colon).find_last_of("{,\n");
  const std::size_t begin =
      text.find_first_not_of(" \t-\"'", before == std::string_view::npos ? 0 : before + 1);
  const std::string_view key = text.substr(begin, colon - begin);
  return key.substr(0, key.find_last_not_of(" \t\"'") + 1);
}

/// The value at `offset`, as it was meant.
std::string_view value_at(std::string_view text, std::size_t offset, bool in_brackets) {
  const std::string_view line = text.substr(offset, text.substr(offset).find_first_of("\r\n"));
  const std::size_t end = std::min(in_brackets ? line.find_first_of(",}]") : line.size(), line.find(" #"));
  const std::string_view value = line.substr(0, end);
  return value.substr(0, value.find_last_not_of(" \t") + 1);
}

/// A name that is no key is a point's, and its value is an address.
bool holds_an_address(std::string_view key) {
  if (!key.empty() && is_letter(key[0]) && sections_with(key) == Section::none) return true;
  const Span<const Key> keys = all_keys();
  return std::any_of(keys.begin(), keys.end(),
                     [key](const Key& each) { return each.name == key && each.kind == ValueKind::address; });
}

/// Explains '%', '@' or a backtick before a text without quotes.
SyntaxError explain_first_character(std::string_view text, std::size_t offset, bool in_brackets) {
  const std::string_view key = key_before(text, offset);
  const std::string_view value = value_at(text, offset, in_brackets);
  std::string remedy = "put a text in quotes";
  if (holds_an_address(key))
    remedy = fmt::format("an address is a number, without '{}' and letters", text[offset]);
  else if (!key.empty() && !value.empty() && value.find_first_of("\"\\") == std::string_view::npos)
    remedy = fmt::format("put the text in quotes, as in '{}: \"{}\"'", key, value);
  return {position_of(text, offset),
          fmt::format("no value begins with '{}' unless it is in quotes", text[offset]), std::move(remedy)};
}

/// Returns an explanation from the text itself; nullopt if the parser's message is the better one.
std::optional<SyntaxError> explain_by_text(std::string_view text, std::size_t offset,
                                           std::string_view message, const Before& before) {
  const auto says = [&](std::string_view begin) { return message.substr(0, begin.size()) == begin; };
  if (says("end of map flow") || says("end of sequence flow"))
    return explain_in_brackets(text, offset, before);
  if (says("unknown token")) return explain_first_character(text, offset, !before.open.empty());
  if (is_json(text)) return std::nullopt;
  if (says("illegal flow end") && !before.open.empty() && text[offset] != closing(text[before.open.back()]))
    return wrong_bracket(text, offset, before.open.back());
  if (!before.open.empty()) return std::nullopt;
  if (says("illegal map value")) return explain_lines(text, offset);
  if (says("end of map not")) return explain_stranger(text, offset);
  return std::nullopt;
}

}  // namespace

SyntaxError explain(std::string_view text, std::size_t offset, std::string_view message) {
  const Before before = look_before(text, offset);
  if (before.hiding_comment != std::string_view::npos)
    return {position_of(text, before.hiding_comment),
            "'#' begins a comment, which hides the closing bracket behind it",
            "close the bracket before the '#', or put text that contains ' #' in quotes"};
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  if (last == std::string_view::npos || offset > last) {
    if (!before.open.empty()) return never_closed(text, before.open.back());
    const Position end = position_of(text, last == std::string_view::npos ? 0 : last + 1);
    return {end, "the file ends too early", "close what is open: a '}', a ']' or a quote"};
  }
  const Position at = position_of(text, offset);
  if (!is_json(text) && indented_by_tab(text, offset))
    return {at, "the line is indented by a tab", "indent with blanks"};
  if (auto better = explain_by_text(text, offset, message, before)) return *better;
  for (const Explanation& known : explanations)
    if (message.substr(0, known.message.size()) == known.message)
      return {at, std::string(known.what), std::string(known.remedy)};
  return {at, std::string(message), "write it as YAML or JSON"};
}

}  // namespace coupler::loader
