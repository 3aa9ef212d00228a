// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/draft_point.hpp"
#include "common/map/loader/reader.hpp"

namespace coupler::loader {

/// `iio:`, `pwm:` and the `safe:` of registers. The point's format, count and scale must be known.
void read_channel(const Reader& reader, DraftPoint& draft, Context& context);

}  // namespace coupler::loader
