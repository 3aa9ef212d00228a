// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler {

constexpr bool starts_with(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

}  // namespace coupler
