// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/gpio/make_lines.hpp"

namespace coupler::node {

/// The GPIO lines of the map, found and requested by the libgpiod that is built in (backend.hpp): as few
/// requests as it allows, each of up to max_group_size lines.
tl::expected<Wiring, std::string> wire(const Map& map, Log& log);

}  // namespace coupler::node
