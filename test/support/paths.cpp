// SPDX-License-Identifier: Apache-2.0
#include "test/support/paths.hpp"

namespace coupler::test {

std::string in_tree(std::string_view path) { return std::string(COUPLER_SOURCE_DIR "/") += path; }

std::string in_build(std::string_view path) { return std::string(COUPLER_BINARY_DIR "/") += path; }

}  // namespace coupler::test
