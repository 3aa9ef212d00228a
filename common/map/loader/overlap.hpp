// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/context.hpp"
#include "common/map/loader/draft_point.hpp"

namespace coupler::loader {

/// Points that share a bit. That is a warning when at most one of the two is writable and neither has a line,
/// otherwise an error; each point is reported once, against one that stands before it in the file.
void check_overlaps(const DraftPoints& points, Context& context);

}  // namespace coupler::loader
