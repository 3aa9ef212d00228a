// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/map/point.hpp"

namespace coupler::test {

/// A holding register of that type at address 6, to be changed by the test.
inline Point point_of(codec::Type type) {
  Point point;
  point.name = "level";
  point.table = Table::holding_registers;
  point.address = 6;
  point.format.type = type;
  if (type == codec::Type::STRING) point.format.length = 12;  // no point is without a register
  point.access = Access::read_write;
  return point;
}

}  // namespace coupler::test
