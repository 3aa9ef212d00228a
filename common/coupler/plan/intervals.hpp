// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/modbus/range.hpp"

namespace coupler::plan {

/// A set of addresses of one table.
class Intervals {
 public:
  Intervals() = default;
  explicit Intervals(std::vector<modbus::Range> ranges);

  /// Every address of `range` is in the set.
  bool covers(modbus::Range range) const;
  /// At least one is.
  bool overlaps(modbus::Range range) const;

 private:
  std::vector<modbus::Range> merged_;  ///< sorted; none touches the next
};

}  // namespace coupler::plan
