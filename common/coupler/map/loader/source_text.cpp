// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/source_text.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler::loader {
namespace {

bool is_refused(char32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7F;
}

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
  const std::size_t end = quoted_end(text, at);
  if (end == std::string_view::npos) return end;
  return text.substr(at, end - at).find('\n') == std::string_view::npos ? end : std::string_view::npos;
}

/// How deep the brackets, lists ("- - -") and keys ("? ? ?") are nested, and how many parts there are, as far
/// as that can be told without a parser: brackets count where a value can begin, so not those of prose.
class Shape {
 public:
  explicit Shape(std::string_view text) : text_(text) {}

  /// A limit that is passed, and the place.
  struct Excess {
    std::size_t at;
    bool is_depth;
  };
  std::optional<Excess> find_excess(std::size_t deepest, std::size_t most_parts) {
    for (std::size_t at = 0; at < text_.size(); ++at) {
      at = look_at(at);
      if (brackets_ > deepest || run_ > deepest) return Excess{std::min(at, text_.size()), true};
      if (parts_ > most_parts) return Excess{std::min(at, text_.size()), false};
    }
    return std::nullopt;
  }

 private:
  bool begins_value() const { return std::string_view("{[,:-?\n").find(previous_) != std::string_view::npos; }

  /// Returns the last character that was looked at.
  std::size_t look_at(std::size_t at) {
    const char c = text_[at];
    if (c == '\n') {
      run_ = 0;
      ++parts_;
      if (brackets_ == 0) previous_ = c;
      return at;
    }
    if (blanks.find(c) != std::string_view::npos) return at;
    if (const std::size_t end = comment_end(text_, at); end != at)
      return end == std::string_view::npos ? text_.size() : end - 1;
    if ((c == '"' || c == '\'') && begins_value()) {
      const std::size_t end = quoted_end(text_, at);
      previous_ = c;
      return end == std::string_view::npos ? text_.size() : end - 1;
    }
    count(c);
    previous_ = c;
    return at;
  }

  void count(char c) {
    if ((c == '[' || c == '{') && begins_value()) ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    run_ = c == '-' || c == '?' ? run_ + 1 : 0;
    if (std::string_view("[{,:-?").find(c) != std::string_view::npos) ++parts_;
  }

  std::string_view text_;
  char previous_ = '\n';  ///< neither blank nor comment
  std::size_t brackets_ = 0;
  std::size_t run_ = 0;
  std::size_t parts_ = 0;
};

class CommentBlanker {
 public:
  CommentBlanker(std::string& text, Problems& problems) : text_(text), problems_(problems) {}

  bool run() {
    for (at_ = 0; at_ < text_.size(); ++at_) {
      if (!skip_comment()) return false;
      if (at_ == text_.size()) break;
      if (!skip_string()) return false;
      count_bracket();
      if (blanks.find(text_[at_]) == std::string_view::npos) previous_ = text_[at_];
    }
    if (!open_.empty() && hiding_ != std::string::npos)
      return fail(hiding_, "'#' begins a comment, which hides the closing bracket behind it",
                  "close the bracket before the '#', or put text that contains ' #' in quotes");
    return open_.empty() || fail(open_.back(), fmt::format("the '{}' is never closed", text_[open_.back()]),
                                 "check the brackets that follow");
  }

 private:
  bool fail(std::size_t at, std::string what, std::string remedy) {
    problems_.error(position_of(text_, at), std::move(what), std::move(remedy));
    return false;
  }

  /// To the character behind the comments that begin here.
  bool skip_comment() {
    while (at_ < text_.size()) {
      const std::size_t end = comment_end(text_, at_);
      if (end == std::string::npos) return fail(at_, "the comment '/*' is never closed", "end it with '*/'");
      if (end == at_) return true;
      if (text_[at_] == '#' && hiding_ == std::string::npos && !open_.empty()) {
        const char closing = text_[open_.back()] == '{' ? '}' : ']';
        if (text_.substr(at_, end - at_).find(closing) != std::string::npos) hiding_ = at_;
      }
      for (; at_ < end; ++at_)
        if (text_[at_] != '\n' && text_[at_] != '\r') text_[at_] = ' ';
    }
    return true;
  }

  /// To the closing quote of the string that begins here.
  bool skip_string() {
    if (!opens_string(text_[at_], previous_)) return true;
    const std::size_t end = string_end(text_, at_);
    if (end == std::string::npos) return fail(at_, "the quote is never closed", "close it in the same line");
    at_ = end - 1;
    return true;
  }

  void count_bracket() {
    if (text_[at_] == '{' || text_[at_] == '[') open_.push_back(at_);
    if ((text_[at_] == '}' || text_[at_] == ']') && !open_.empty()) open_.pop_back();
  }

  std::string& text_;
  Problems& problems_;
  std::size_t at_ = 0;
  char previous_ = '\0';                    ///< the last character that is neither blank nor comment
  std::vector<std::size_t> open_;           ///< brackets
  std::size_t hiding_ = std::string::npos;  ///< a comment in which a bracket is closed
};

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.substr(0, mark.size()) == mark ? text.substr(mark.size()) : text;
}

bool check_text(std::string_view text, Problems& problems) {
  if (text.size() > max_text_size) {
    problems.error(
        {}, fmt::format("the file has {} bytes, but a map may have at most {}", text.size(), max_text_size),
        "give the file of a map");
    return false;
  }
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    const auto code = static_cast<unsigned>(c.code);
    if (!c.valid) {
      problems.error(position_of(text, i), fmt::format("byte 0x{:02X} is not UTF-8", code),
                     "save the file as UTF-8");
      return false;
    }
    if (is_refused(c.code)) {
      problems.error(position_of(text, i), fmt::format("control character 0x{:02X}", code), "remove it");
      return false;
    }
    i += c.size;
  }
  return true;
}

void indent_with_blanks(std::string& text) {
  constexpr const char* blanks = " \t";
  for (std::size_t tab = text.find('\t'); tab != std::string::npos; tab = text.find('\t', tab)) {
    const std::size_t before = text.find_last_not_of(blanks, tab);
    const std::size_t after = std::min(text.find_first_not_of(blanks, tab), text.size());
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const bool starts_line = begin == 0 || text[begin - 1] == '\n';
    const bool ends_line = after == text.size() || text[after] == '\n' || text[after] == '\r';
    const bool is_comment = begin == tab && after < text.size() && text[after] == '#';
    if (starts_line && (ends_line || is_comment)) std::fill(text.begin() + begin, text.begin() + after, ' ');
    tab = after;
  }
}

bool check_shape(std::string_view text, Problems& problems) {
  constexpr std::size_t deepest = 64;            // of characters; the tree may have 16 levels
  constexpr std::size_t most_parts = 4'000'000;  // yaml-cpp takes some 240 bytes for each
  const auto excess = Shape(text).find_excess(deepest, most_parts);
  if (!excess) return true;
  if (excess->is_depth)
    problems.error(position_of(text, excess->at), "the values are nested too deep",
                   "a map has at most five levels");
  else
    problems.error(position_of(text, excess->at), fmt::format("the file has more than {} parts", most_parts),
                   "give the file of a map");
  return false;
}

Position position_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const std::size_t newline = before.rfind('\n');
  const std::size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
  return {static_cast<int>(1 + std::count(before.begin(), before.end(), '\n')),
          static_cast<int>(1 + before.size() - line_start)};
}

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

bool is_json(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = comment_end(text, i);
    if (end == std::string_view::npos) return false;
    if (end == i && blanks.find(text[i]) == std::string_view::npos) return text[i] == '{';
    i = std::max(end, i + 1);
  }
  return false;
}

bool blank_comments(std::string& text, Problems& problems) { return CommentBlanker(text, problems).run(); }

}  // namespace coupler::loader
