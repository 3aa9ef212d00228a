// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace coupler::test {

/// Of a file of this tree, as "test/maps/bad".
std::string in_tree(std::string_view path);
/// Of a file that the build has made.
std::string in_build(std::string_view path);

}  // namespace coupler::test
