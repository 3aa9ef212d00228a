// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coupler {

/// The text of a map that loads, without these keys at its top. Comments above the key that follows go with
/// them.
std::string without_keys(std::string_view text, const std::vector<std::string_view>& keys);

}  // namespace coupler
