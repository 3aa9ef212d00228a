// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler::generate {

/// It can name a namespace in generated code: letters, digits and underscores, a letter first, no word of
/// C++.
bool is_identifier(std::string_view name);

}  // namespace coupler::generate
