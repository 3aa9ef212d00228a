// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/reader.hpp"
#include "common/map/point.hpp"

namespace coupler::loader {

/// `scale:`, a number or a map of gain and offset.
void read_scale(const Reader& reader, Point& point, Context& context);

}  // namespace coupler::loader
