// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/core/sink.hpp"

namespace coupler::driver {

/// Before ROS is there: to standard error, escaped in the same way.
void print(std::string_view text);

/// Writes to rosout and the console, escaped as printable_lines() does.
void log(Level level, const std::string& text);

/// Whether log_debug() says anything; costs nothing.
bool is_debug_logged();
void log_debug(const std::string& text);

}  // namespace coupler::driver
