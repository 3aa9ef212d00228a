// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::host {

/// What stands in the way of a read request that was rejected although its points can be read.
struct Refusal {
  Table table;
  modbus::Range range;
  bool between_points;  ///< addresses that no point needs; otherwise they are answered in parts, not as one
};

/// What it means for the map, in one line.
std::string to_string(const Refusal& refusal);

}  // namespace coupler::host
