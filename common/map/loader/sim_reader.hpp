// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/map/loader/draft_point.hpp"
#include "common/map/loader/reader.hpp"
#include "common/map/map.hpp"

namespace coupler::loader {

/// `sim:`, the wires of the simulated chip: each from a coil, or with a square wave, to a discrete input of
/// its own.
std::vector<SimWire> read_sim(const Reader& top, const DraftPoints& points, Context& context);

}  // namespace coupler::loader
