// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler::host {

/// The files of page/, as browsers get them.
std::string_view panel_page();
std::string_view panel_script();
std::string_view panel_style();

}  // namespace coupler::host
