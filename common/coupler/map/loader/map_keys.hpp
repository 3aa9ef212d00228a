// SPDX-License-Identifier: Apache-2.0
// The keys at the top of a map: map_reader.cpp calls each of these. Each is in a file of its own.
#pragma once

#include <optional>
#include <vector>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/service.hpp"

namespace coupler::loader {

/// What the top of the file says about the coupler, not about its points.
Connection read_connection(const Reader& top, Context& context);
Polling read_polling(const Reader& top);
Limits read_limits(const Reader& top);

/// What the top of the file says about a node that serves the map.
Service read_service(const Reader& top, Context& context);

/// `sim:`, the wires of the simulated chip: each from a coil, or with a square wave, to a discrete input of
/// its own.
std::vector<SimWire> read_sim(const Reader& top, const DraftPoints& points, Context& context);

/// `watchdog:` of a map with `preset`: there it is the coupler's own, and leaves `head.service`. Without a
/// preset it is the node's, and stays.
void read_coupler_watchdog(const Reader& top, const std::optional<Preset>& preset, const DraftPoints& points,
                           Addressing addressing, Map& head, Context& context);

}  // namespace coupler::loader
