// SPDX-License-Identifier: Apache-2.0
// The files of style/ and script/, put into the program at build time.
#pragma once

#include <string_view>

namespace coupler::docs {

std::string_view style_sheet();
std::string_view head_script();
std::string_view page_script();

}  // namespace coupler::docs
