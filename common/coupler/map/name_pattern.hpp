// SPDX-License-Identifier: Apache-2.0
// Patterns of points' names, as a shell has them: '*', '?' and '[…]'; '*' matches '/', too.
#pragma once

#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/point.hpp"

namespace coupler {

bool matches(std::string_view pattern, std::string_view name);

/// Marks the points whose names match, and leaves the others as they are. Returns whether there is one.
bool mark_matching(std::string_view pattern, Span<const Point> points, std::vector<bool>& marked);

}  // namespace coupler
