// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler {

/// The version of this project. CMakeLists.txt has the same; coupler/tools/main.cpp checks that.
constexpr std::string_view version = "0.1.0";

}  // namespace coupler
