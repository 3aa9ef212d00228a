// SPDX-License-Identifier: Apache-2.0
// Takes numbers and words from the front of a cell's text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace coupler::formats {

/// Takes blanks and tabs.
void drop_blanks(std::string_view& text);

/// The text without those around it.
std::string_view without_blanks(std::string_view text);

/// False if the text does not begin so.
bool take_word(std::string_view& text, std::string_view word);

/// Takes "6553.5", "-40", "0,5", ".5" or "0x10", and returns it as a map writes it.
std::optional<std::string> take_number(std::string_view& text);

/// Takes "0.1", "1/10", "1:10", "10^-1" or "1e-1".
std::optional<std::string> take_factor(std::string_view& text);

}  // namespace coupler::formats
