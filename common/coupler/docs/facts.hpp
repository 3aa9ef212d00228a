// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::docs {

struct Fact {
  std::string label;
  std::string value;
};

/// Settings of one kind, "Connection", "Limits" …
struct FactGroup {
  std::string title;
  std::vector<Fact> facts;
};

/// What the map says of the device as a whole, in a fixed order. Groups that do not concern it are left out.
std::vector<FactGroup> facts_of(const Map& map);

}  // namespace coupler::docs
