// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace coupler::loader {

/// An entry without its ':', as in 'lamp {address: 1}' and 'lamp= 0', or without the blank behind it, as in
/// 'clamp:0'. YAML takes them for text, and for something else in the next line.
struct ColonSlip {
  std::string what;
  std::string_view name;
  std::string_view value;

  /// "write 'clamp: 0'"
  std::string remedy() const;
};

/// Returns what is wrong with the ':' of the entry that a text begins with; nullopt if the entry has one, or
/// the text is a single word.
std::optional<ColonSlip> colon_slip(std::string_view text);

}  // namespace coupler::loader
