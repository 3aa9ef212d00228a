// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/host/scan/prober.hpp"

namespace coupler::scan {

/// Those of `units` that are there. Each is asked for its first holding register. An exception is an answer,
/// too, unless a gateway gives it for a unit that is away (0A, 0B). A unit that stays silent costs one
/// timeout. Some devices close the connection, or stay silent, in place of refusing an address: then the
/// first address of the other tables is tried, after a silence only if no other unit is to be asked.
std::vector<std::uint8_t> find_units(Prober& prober, ScanProgress& progress,
                                     const std::vector<std::uint8_t>& units);

}  // namespace coupler::scan
