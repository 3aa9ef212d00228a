// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::plan {

/// The requests to try instead of one that the device rejects.
struct Split {
  std::vector<ReadSpan> pieces;         ///< two, or none if the request holds one point only
  std::optional<modbus::Range> hole{};  ///< the addresses between the pieces, which neither asks for
};

/// Parts the points of `span` where addresses lie between them that no point of it needs, at the place
/// nearest to the middle; if there is none, as near to the middle as points that overlap stay together.
Split split(const ReadSpan& span, const Map& map);

}  // namespace coupler::plan
