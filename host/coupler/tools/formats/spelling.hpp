// SPDX-License-Identifier: Apache-2.0
// Names in the letters that a topic may have: "Ölstand" is "oelstand".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace coupler::formats {

/// The name in small letters of ASCII; nullopt, with the first character for which there are none in
/// `unknown`.
std::optional<std::string> in_ascii(std::string_view name, std::string& unknown);

/// It has letters that are not ASCII's. A name with signs alone, such as "Temp °C", keeps its capital
/// letters.
bool needs_spelling(std::string_view name);

}  // namespace coupler::formats
