// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/reader.hpp"
#include "common/map/point.hpp"

namespace coupler::loader {

/// A value of the point, given by `key` (`initial`, `safe`, …), as range(point).count() registers as they
/// stand on the wire. A scaled point's is written as it is published. An array takes a list, or one value for
/// all of its elements. Empty if it is wrong. The point's format, count and scale must be known.
Span<const std::uint16_t> read_value(std::string_view key, const Entry& entry, const Point& point,
                                     Context& context);

}  // namespace coupler::loader
