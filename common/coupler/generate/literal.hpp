// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace coupler::generate {

/// A C++ string literal, quotes included, that stands for exactly these bytes, whatever they are.
std::string literal(std::string_view text);

/// The same as adjacent literals, one per line of the text, each on its own line after `indent`; no newline
/// at the end.
std::string literal_lines(std::string_view text, std::string_view indent);

/// One line for a `//` comment: control characters become blanks, characters that turn the writing direction
/// (the compiler warns of them) go.
std::string comment(std::string_view text);

}  // namespace coupler::generate
