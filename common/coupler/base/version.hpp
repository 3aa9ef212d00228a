// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler {

/// Of this project; CMakeLists.txt says the same, which coupler/cli checks.
constexpr std::string_view version = "0.1.0";

}  // namespace coupler
