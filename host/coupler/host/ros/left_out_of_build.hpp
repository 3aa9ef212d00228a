// SPDX-License-Identifier: Apache-2.0
// Only for targets that link coupler_ros: it defines COUPLER_WITH_CONTROL_MSGS.
#pragma once

#include <string_view>

namespace coupler::host {

/// The end of what --version prints.
#ifdef COUPLER_WITH_CONTROL_MSGS
constexpr std::string_view left_out_of_build{};
#else
constexpr std::string_view left_out_of_build = " without control_msgs";
#endif

}  // namespace coupler::host
