// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/draft_point.hpp"
#include "common/map/loader/reader.hpp"
#include "common/map/map.hpp"

namespace coupler::loader {

/// `counter:` of a register that holds a whole number of 16, 32 or 64 bits; `latched:` of a coil without a
/// line or a bit of a holding register. Comes after type, access and line.
void read_edges(const Reader& point, DraftPoint& draft, Context& context);

/// What they name is a discrete input that can have edges: wired, or at the end of a simulated wire.
void check_edges(const DraftPoints& points, Span<const SimWire> sim, Context& context);

}  // namespace coupler::loader
