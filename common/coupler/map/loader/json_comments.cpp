// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/json_comments.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/source_text.hpp"
#include "coupler/map/loader/syntax.hpp"

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
    return open_.empty() || fail(open_.back(), fmt::format("the '{}' is never closed", text_[open_.back()]),
                                 "count the brackets that follow");
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
  char previous_ = '\0';           ///< the last character that is neither blank nor comment
  std::vector<std::size_t> open_;  ///< brackets
};

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

bool blank_comments(std::string& text, Problems& problems) { return CommentBlanker(text, problems).run(); }

}  // namespace coupler::loader
