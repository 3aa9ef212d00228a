// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/json_comments.hpp"

#include <algorithm>

#include "common/map/loader/source_text.hpp"
#include "common/map/loader/syntax_check.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool starts_with(std::string_view text, std::size_t at, std::string_view what) {
  return text.substr(at, what.size()) == what;
}

/// One past the comment that begins at `at`: "//" and "#" reach to the end of the line. `at` if there is
/// none, npos if it has no end.
std::size_t comment_end(std::string_view text, std::size_t at) {
  if (starts_with(text, at, "/*")) {
    const std::size_t end = text.find("*/", at + 2);
    return end == std::string_view::npos ? end : end + 2;
  }
  const bool hash = text[at] == '#' && (at == 0 || blanks.find(text[at - 1]) != std::string_view::npos);
  if (hash || starts_with(text, at, "//")) return std::min(text.find('\n', at), text.size());
  return at;
}

/// A quote opens a string only where a value or key can begin; elsewhere it is an apostrophe.
bool opens_string(char c, char previous) {
  return (c == '"' || c == '\'') && std::string_view("{[,:").find(previous) != std::string_view::npos;
}

/// One past the closing quote, or npos if the line ends before it.
std::size_t string_end(std::string_view text, std::size_t at) {
  return quoted_end(text.substr(0, std::min(text.find('\n', at), text.size())), at);
}

void blank(std::string& text, std::size_t from, std::size_t to) {
  const auto at = [&](std::size_t i) { return text.begin() + static_cast<std::ptrdiff_t>(i); };
  std::replace_if(
      at(from), at(to), [](char c) { return c != '\n' && c != '\r'; }, ' ');
}

}  // namespace

bool is_json(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = comment_end(text, i);
    if (end == std::string_view::npos) return false;
    if (end == i && blanks.find(text[i]) == std::string_view::npos) return text[i] == '{';
    i = std::max(end, i + 1);
  }
  return false;
}

bool blank_comments(std::string& text, Problems& problems) {
  char previous = '\0';  // the last character that is neither blank nor comment
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = comment_end(text, i);
    if (end == std::string::npos) {
      problems.error(position_of(text, i), "the comment '/*' is never closed", "end it with '*/'");
      return false;
    }
    if (end != i) {
      blank(text, i, end);
      i = end;
      continue;
    }
    if (opens_string(text[i], previous)) {
      const std::size_t after = string_end(text, i);
      if (after == std::string::npos) {
        problems.error(position_of(text, i), "the quote is never closed", "close it in the same line");
        return false;
      }
      i = after - 1;
    }
    if (blanks.find(text[i]) == std::string_view::npos) previous = text[i];
    ++i;
  }
  return true;
}

}  // namespace coupler::loader
