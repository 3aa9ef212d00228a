// SPDX-License-Identifier: Apache-2.0
// Mistakes that yaml-cpp lets pass, found by a second look at the text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace coupler::loader {

/// One past the closing quote of the string that begins at `at`; npos if it is never closed. `at` itself if
/// no quote stands there.
std::size_t quoted_end(std::string_view text, std::size_t at);

/// A ':' follows the key that begins at `at`; without one yaml-cpp takes any text for a key with no value.
bool has_colon(std::string_view text, std::size_t at, std::string_view key);

/// Where a comma is missing in a JSON document: bare words and numbers hold no blanks, but yaml-cpp reads
/// `"b": 2 "c"` as the text `2 "c"`.
std::optional<std::size_t> missing_comma(std::size_t at, std::string_view bare_text);

}  // namespace coupler::loader
