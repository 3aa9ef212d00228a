// SPDX-License-Identifier: Apache-2.0
// The file before YAML sees it: bytes, characters, lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "coupler/map/loader/entry.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::loader {

/// Larger files are not maps, and positions must fit into an int.
constexpr std::size_t max_text_size = std::size_t{16} << 20U;

/// Without the byte order mark that some editors put in front.
std::string_view without_byte_order_mark(std::string_view text);

/// The text is UTF-8 of printable characters, tabs and newlines. yaml-cpp would take other control characters
/// for the end of the file or for another encoding, without a word.
bool check_text(std::string_view text, Problems& problems);

/// Blanks in place of tabs where only nothing or a comment follows: yaml-cpp takes them for wrong
/// indentation.
void indent_with_blanks(std::string& text);

/// Where the byte at `offset` stands.
Position position_of(std::string_view text, std::size_t offset);

}  // namespace coupler::loader
