// SPDX-License-Identifier: Apache-2.0
// A second look at the text: mistakes that yaml-cpp lets pass, and what those mean that it finds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/loader/entry.hpp"

namespace coupler::loader {

/// One past the closing quote of the string that begins at `at`; npos if it is never closed. `at` itself if
/// no quote stands there.
std::size_t quoted_end(std::string_view text, std::size_t at);

/// A ':' follows the key that begins at `at`; without one yaml-cpp takes any text for a key with no value.
bool has_colon(std::string_view text, std::size_t at, std::string_view key);

/// Where a comma is missing in a JSON document: bare words and numbers hold no blanks, but yaml-cpp reads
/// `"b": 2 "c"` as the text `2 "c"`.
std::optional<std::size_t> missing_comma(std::size_t at, std::string_view bare_text);

/// Why a text is no document. Thrown through yaml-cpp, which knows no other way to stop; never leaves
/// document.cpp.
struct SyntaxError {
  Position at;
  std::string what;
  std::string remedy;
};

/// yaml-cpp's `message` about `offset` of `text`, in words that help.
SyntaxError explain(std::string_view text, std::size_t offset, std::string_view message);

}  // namespace coupler::loader
