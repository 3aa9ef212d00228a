// SPDX-License-Identifier: Apache-2.0
// The text of a file before the YAML parser sees it: characters, lines, quotes, comments.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::loader {

/// Larger files are not maps, and positions must fit into an int.
constexpr std::size_t max_text_size = std::size_t{16} << 20U;

/// Without the byte order mark that some editors put in front.
std::string_view without_byte_order_mark(std::string_view text);

/// The text is UTF-8 of printable characters, tabs and newlines. yaml-cpp would silently take other control
/// characters for the end of the file or for another encoding.
bool check_text(std::string_view text, Problems& problems);

/// The text is neither nested too deep nor in too many parts for a parser, which would take its time and
/// memory before it tells.
bool check_shape(std::string_view text, Problems& problems);

/// Blanks in place of the tabs of empty lines and before comments: yaml-cpp takes them for wrong indentation.
void indent_with_blanks(std::string& text);

/// Returns line and column of the byte at `offset`.
Position position_of(std::string_view text, std::size_t offset);

/// One past the closing quote of the string that begins at `at`; npos if it is never closed. `at` itself if
/// no quote stands there.
std::size_t quoted_end(std::string_view text, std::size_t at);

/// The first character outside blanks and comments is "{": a JSON document, in which comments are allowed.
bool is_json(std::string_view text);

/// Puts blanks in the place of // and /* */ comments outside strings, so that lines and columns stay.
/// False, with the reason in `problems`, if a comment, a string or a bracket has no end.
bool blank_comments(std::string& text, Problems& problems);

}  // namespace coupler::loader
