// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/core/sink.hpp"

namespace coupler::driver {

/// Writes to rosout and the console.
void log(Level level, const std::string& text);

}  // namespace coupler::driver
