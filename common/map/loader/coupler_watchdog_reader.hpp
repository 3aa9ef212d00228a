// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/map/loader/address.hpp"
#include "common/map/loader/preset.hpp"

namespace coupler::loader {

/// `watchdog:` of a map with `preset`: there it is the coupler's own, and leaves `head.service`. Without a
/// preset it is the node's, and stays.
void read_coupler_watchdog(const Reader& top, const std::optional<Preset>& preset, const DraftPoints& points,
                           Addressing addressing, Map& head, Context& context);

}  // namespace coupler::loader
