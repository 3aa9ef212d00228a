// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/gpio/make_lines.hpp"

namespace coupler::node::libgpiod1 {

/// The GPIO lines of the map, requested by libgpiod 1: a request for all lines of one chip with one direction
/// and one set of flags, up to max_group_size of them; one for each debounced input.
tl::expected<Wiring, std::string> wire(const Map& map, Log& log);

}  // namespace coupler::node::libgpiod1
