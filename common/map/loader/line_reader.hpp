// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/draft_point.hpp"
#include "common/map/loader/reader.hpp"

namespace coupler::loader {

/// The GPIO line of a coil or discrete input: `line: GPIO17`, `line: {chip: gpiochip0, offset: 17}` or
/// `line: {name: GPIO17}`. What the line is like (active_low, bias, drive, debounce) is said beside `line` or
/// inside it, not in both; what the node does with it (safe, initial) only beside it.
void read_line(const Reader& point, DraftPoint& draft, Context& context);

}  // namespace coupler::loader
