// SPDX-License-Identifier: Apache-2.0
// Texts of a map are not trusted: pages show them and never interpret them.
#pragma once

#include <string>
#include <string_view>

namespace coupler {

/// Escapes a text for XML, as SVG, and for the text and quoted attributes of HTML.
std::string html(std::string_view text);

/// Escapes a text for the inline text of GitHub-flavoured Markdown, also within a cell of a table: a
/// backslash before all punctuation that means something within a line, and HTML's entities for what HTML
/// would interpret.
std::string markdown(std::string_view text);

/// Returns a text without line breaks and other control characters, which would end what it stands in.
std::string one_line(std::string_view text);

/// Returns a path as part of a URL: what is not unreserved becomes %XX (RFC 3986, 2.3), slashes stay.
std::string url_path(std::string_view path);

}  // namespace coupler
