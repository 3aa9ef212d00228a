// SPDX-License-Identifier: Apache-2.0
#include "host/core/write.hpp"

#include <algorithm>
#include <cassert>

namespace coupler::driver {

Write make_write(const Map& map, std::uint32_t point, Span<const std::uint16_t> value) {
  Write write;
  write.point = point;
  if (map.points[point].table == Table::coils) {
    for (std::size_t i = 0; i < value.size(); ++i)
      if (value[i] != 0) write.set_bit(i);
  } else {
    assert(value.size() <= write.registers.size());
    std::copy(value.begin(), value.end(), write.registers.begin());
  }
  return write;
}

}  // namespace coupler::driver
