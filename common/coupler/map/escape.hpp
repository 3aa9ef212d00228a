// SPDX-License-Identifier: Apache-2.0
// Texts of a map are not trusted: pages show them and never interpret them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "coupler/map/printable.hpp"

namespace coupler {

/// Escapes a text for XML, as SVG, and for the text and quoted attributes of HTML.
std::string html(std::string_view text);

/// Escapes a text for the inline text of GitHub-flavoured Markdown, also within a cell of a table: a
/// backslash before all punctuation that means something within a line, and HTML's entities for what HTML
/// would interpret.
std::string markdown(std::string_view text);

/// Returns a text without line breaks and other control characters, which would end what it stands in.
std::string one_line(std::string_view text);

/// Returns a text in double quotes, with a backslash before quotes and backslashes. `escape(c, bytes)`
/// returns what stands for a Character, or nothing where it stands for itself.
template <class Escape>
std::string double_quoted(std::string_view text, const Escape& escape) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    const std::string_view bytes = text.substr(at, c.size);
    at += c.size;
    const bool is_special = bytes == "\"" || bytes == "\\";
    const std::string escaped = is_special ? '\\' + std::string(bytes) : escape(c, bytes);
    out += escaped.empty() ? bytes : escaped;
  }
  return out + '"';
}

/// Returns a path as part of a URL: what is not unreserved becomes %XX (RFC 3986, 2.3), slashes stay.
std::string url_path(std::string_view path);

}  // namespace coupler
