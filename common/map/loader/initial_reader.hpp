// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/reader.hpp"
#include "common/map/point.hpp"

namespace coupler::loader {

/// `initial:`, put into registers as they stand on the wire. The point's format must be known.
void read_initial(const Reader& reader, Point& point, Context& context);

}  // namespace coupler::loader
