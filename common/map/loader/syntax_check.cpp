// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/syntax_check.hpp"

namespace coupler::loader {

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

}  // namespace coupler::loader
