// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "coupler/codec/number.hpp"

namespace coupler::host {

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

namespace {

template <class T>
bool are_finite(const Point& point, const std::uint16_t* registers) {
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i)
    if (!std::isfinite(codec::take<T>(point.format, registers + i * width))) return false;
  return true;
}

}  // namespace

bool is_finite(const Point& point, const Write& write) {
  if (holds_bits(point.table)) return true;
  switch (point.format.type) {
    case codec::Type::REAL: return are_finite<float>(point, write.registers.data());
    case codec::Type::LREAL: return are_finite<double>(point, write.registers.data());
    default: return true;
  }
}

}  // namespace coupler::host
