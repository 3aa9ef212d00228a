// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/map/map.hpp"

namespace coupler::scan {

/// Returns what to write behind its name in a map: "{address: 100, type: REAL, order: CDAB}".
std::string point_text(const Candidate& candidate, bool with_order);

/// The value as it was read, in as few digits as its type needs: "230.4".
std::string value_text(const Candidate& candidate);

/// The lines of a map that say where the device is.
std::string connection_text(const Connection& connection);

/// A map of all that can be read, in YAML, with comments: each known value is a point of its own, the rest
/// arrays of UINT; all of them read-only, since a write may do anything.
std::string draft_map(const Findings& findings, const Connection& connection,
                      const std::vector<Match>& matches);

}  // namespace coupler::scan
