// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/map/loader/reader.hpp"
#include "coupler/map/point.hpp"

namespace coupler::loader {

/// A point as far as it could be read, and where it stands in the file.
struct DraftPoint {
  const Entry* entry;  ///< in the file
  Reader options;      ///< the keys below it
  Point point{};
  Position name_at{};
  Position address_at{};
  Position line_at{};        ///< `line`, `iio` or `pwm`
  Position edge_at{};        ///< the input that `counter` or `latched` names
  bool placed = false;       ///< address and format are known, and the range ends by 65535
  bool addressless = false;  ///< the file gives no address, and is right so far
  bool part_given = false;   ///< the file says which half or bit of its register it is
};

using DraftPoints = std::vector<DraftPoint>;

}  // namespace coupler::loader
