// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "coupler/plan/cost.hpp"

namespace coupler::plan {

/// A way to treat unmapped addresses between points, and what it would cost.
struct Strategy {
  std::string_view name;
  Polling polling;  ///< the map's with the keys that the way needs
  Cost cost;        ///< of one cycle of every rate
  double load = 0;  ///< of all rates together
};

/// Never read them; as the map says; wherever that is quicker than another request. The last one's gaps are
/// the smallest that do it. It presumes that the device answers them.
std::array<Strategy, 3> compare_strategies(const Map& map, const Link& link);

}  // namespace coupler::plan
