// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// Writes to rosout and the console, escaped as printable_lines() does.
void ros_log(Level level, const std::string& text);

/// Whether ros_log_debug() says anything; costs nothing.
bool is_debug_logged();
void ros_log_debug(const std::string& text);

}  // namespace coupler::host
