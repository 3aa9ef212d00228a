// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/line_error.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "coupler/map/loader/colon_slip.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view spaces = " \t\r";

/// Returns the place of the ':' that makes the line an entry; npos if none does. One in quotes does not
/// count.
std::size_t entry_colon(std::string_view line) {
  char previous = '\n';
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (std::string_view("{[,:-\n").find(previous) != std::string_view::npos)
      if (const std::size_t end = quoted_end(line, i); end != i) {
        if (end == std::string_view::npos) return end;
        previous = line[i];
        i = end - 1;
        continue;
      }
    if (line[i] == ':' && (i + 1 == line.size() || spaces.find(line[i + 1]) != std::string_view::npos))
      return i;
    if (spaces.find(line[i]) == std::string_view::npos) previous = line[i];
  }
  return std::string_view::npos;
}

/// A line that is neither empty nor a comment.
struct Line {
  std::size_t begin;  ///< of its first character behind the indentation
  std::size_t indent;
  std::string_view text;  ///< without indentation, comment and blanks at the end

  bool is_entry() const { return entry_colon(text) != std::string_view::npos; }
  bool is_list_item() const { return text == "-" || text.substr(0, 2) == "- "; }
  /// The entry's value stands in this line.
  bool has_value() const { return is_entry() && entry_colon(text) + 1 < text.size(); }
};

std::string_view without_comment(std::string_view line) {
  if (line.substr(0, 1) == "#") return {};
  const std::size_t hash =
      std::min(line.find(" #"), line.size());  // in quotes, too: what matters comes before
  const std::size_t last = line.substr(0, hash).find_last_not_of(spaces);
  return last == std::string_view::npos ? std::string_view{} : line.substr(0, last + 1);
}

Line line_at(std::string_view text, std::size_t offset) {
  const std::size_t newline = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const std::size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  const std::size_t begin = std::min(text.find_first_not_of(spaces, start), end);
  return {begin, begin - start, without_comment(text.substr(begin, end - begin))};
}

/// The line above that is neither empty nor a comment.
std::optional<Line> above(std::string_view text, const Line& line) {
  for (std::size_t start = line.begin - line.indent; start > 0;) {
    const Line found = line_at(text, start - 1);
    if (!found.text.empty()) return found;
    start = found.begin - found.indent;
  }
  return std::nullopt;
}

SyntaxError missing_colon(std::string_view text, const Line& line) {
  const Position at = position_of(text, line.begin);
  if (const auto slip = colon_slip(line.text)) return {at, slip->what, slip->remedy()};
  return {at, fmt::format("':' is missing after {}", shown(line.text)),
          "write " + shown(fmt::format("{}:", line.text))};
}

/// The first of the lines directly above that have no ':', unless they are the rest of a text.
std::optional<Line> first_without_colon(std::string_view text, const Line& here) {
  constexpr int most_lines = 100;
  std::optional<Line> first;
  auto line = above(text, here);
  for (int i = 0; line && !line->is_entry() && !line->is_list_item(); line = above(text, *line), ++i) {
    if (line->text == "---" || i == most_lines) return first;
    first = line;
  }
  const bool is_rest_of_text = line && first && line->has_value() && first->indent > line->indent;
  return is_rest_of_text ? std::nullopt : first;
}

}  // namespace

SyntaxError text_behind(char quote, std::string_view text, std::size_t offset) {
  return {position_of(text, offset), "text follows the closing quote",
          quote == '"' ? "write a quote inside double quotes as '\\\"', or use single quotes"
                       : "double an apostrophe inside single quotes, or use double quotes"};
}

std::optional<SyntaxError> explain_lines(std::string_view text, std::size_t offset) {
  const Line here = line_at(text, offset);
  if (const auto slip = colon_slip(here.text))
    return SyntaxError{position_of(text, here.begin), slip->what, slip->remedy()};
  if (const std::size_t colon = entry_colon(here.text);
      colon != std::string_view::npos && here.begin + colon < offset)
    return SyntaxError{position_of(text, offset), "a second ':' stands in this line",
                       "write one 'key: value' a line; put text that contains ': ' in quotes"};
  if (const auto line = first_without_colon(text, here)) return missing_colon(text, *line);
  if (const auto line = above(text, here); line && line->has_value() && here.indent > line->indent)
    return SyntaxError{position_of(text, here.begin),
                       fmt::format("this line is indented more than {} above it, which has its value already",
                                   shown(line->text)),
                       "begin both in one column; put text that contains ': ' in quotes"};
  return std::nullopt;
}

std::optional<SyntaxError> explain_stranger(std::string_view text, std::size_t offset) {
  const Line here = line_at(text, offset);
  const Position at = position_of(text, offset);
  if (offset > here.begin && text[offset] == ',')
    return SyntaxError{at, "',' does not belong here", "remove it: entries in lines of their own need none"};
  if (offset > here.begin) {
    const char previous = text[text.find_last_not_of(' ', offset - 1)];
    if (previous == '\'' || previous == '"') return text_behind(previous, text, offset);
    return SyntaxError{at, "the value has ended before this", "write one 'key: value' a line"};
  }
  const auto before = above(text, here);
  if (here.is_list_item())
    return SyntaxError{at, "'- ' begins a list among entries", "leave the '- ' out: write 'key: value'"};
  if (!before) return std::nullopt;
  if (!before->is_entry() && !before->is_list_item()) return missing_colon(text, *before);
  return SyntaxError{
      at, "this does not belong to the entries above",
      fmt::format("check the indentation: {} here, {} in the line above", here.indent, before->indent)};
}

}  // namespace coupler::loader
