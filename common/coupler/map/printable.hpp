// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coupler {

/// A character of UTF-8.
struct Character {
  char32_t code;
  std::size_t size;   ///< bytes
  bool valid = true;  ///< false: a byte that begins no character, which stands for itself
};

/// The character that begins at `at`, which is inside the text.
Character character_at(std::string_view text, std::size_t at);

/// C0, DEL and C1, newline and tab included. A terminal obeys them.
bool is_control(char32_t code);
/// They turn the direction of writing: what is shown is not what is there.
bool turns_direction(char32_t code);

/// Text from a map, a device, a client or a file as one line of a terminal or log. Characters that are obeyed
/// and bytes that are no UTF-8 are escaped: "\x1b", "\x9b", "\u202e", "\xff".
std::string printable(std::string_view text);

/// Quotes a text in a message: what printable() makes of it, or of the beginning of a long one.
std::string excerpt(std::string_view text);

/// The same for text of several lines: newlines and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace coupler
