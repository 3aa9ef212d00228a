// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coupler {

/// Returns the text, or the beginning of a long one: `most` bytes of UTF-8 without a character that is cut,
/// and "…".
inline std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  while (most > 0 && continues(most)) --most;
  return std::string(text.substr(0, most)) + "…";
}

}  // namespace coupler
