// SPDX-License-Identifier: Apache-2.0
// What a map must keep beyond each key by itself. Names and overlaps have files of their own.
#pragma once

#include "common/map/loader/context.hpp"
#include "common/map/loader/draft_point.hpp"
#include "common/map/map.hpp"

namespace coupler::loader {

/// A GPIO line belongs to one point.
void check_lines(const DraftPoints& points, Context& context);

/// A point is read and written in one request, so it fits into the device's limits.
void check_sizes(const DraftPoints& points, const Limits& limits, Context& context);

/// One warning for a map that counts from zero by default although most of its numbers look like Modicon's.
void warn_of_modicon_numbers(const DraftPoints& points, Context& context);

}  // namespace coupler::loader
