// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coupler {

/// A line of a file as it may be shown: of a long line only what is around the caret, no control characters
/// but tabs, none that turn the direction of writing, valid UTF-8.
struct SourceSnippet {
  std::string text;
  std::size_t caret = 0;  ///< the byte of `text` that is meant; its size: the end of the line
};

/// `line` is the whole line, `column` counts its bytes from 1.
SourceSnippet snippet(std::string_view line, int column);

/// What stands below the text: blanks as wide as what is before the caret, "^", and "~" to the end of the
/// word.
std::string underline(const SourceSnippet& snippet);

}  // namespace coupler
