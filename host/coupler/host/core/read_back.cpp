// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/read_back.hpp"

#include <algorithm>

namespace coupler::host {

Result<> ReadBack::read(const Write& write, const Map& map, Transport& transport) {
  const Point& point = map.points[write.point];
  const modbus::Range where = read_range(point);
  count_ = where.count();
  if (point.table == Table::coils) {
    std::array<std::uint8_t, modbus::max_read_bits> bits{};
    if (auto read = transport.read_bits(point.table, where, bits.data()); !read) return read;
    std::copy_n(bits.begin(), count_, found_.begin());
    for (std::size_t i = 0; i < count_; ++i) written_[i] = write.bit(i) ? 1 : 0;
    return {};
  }
  if (auto read = transport.read_registers(point.table, where, found_.data()); !read) return read;
  const auto mask = is_partial(point) ? codec::mask(point.format) : std::uint16_t{0xFFFF};
  for (std::size_t i = 0; i < count_; ++i) {
    written_[i] = write.registers[i] & mask;
    found_[i] = found_[i] & mask;
  }
  return {};
}

bool ReadBack::is_equal() const {
  return std::equal(written_.begin(), written_.begin() + static_cast<std::ptrdiff_t>(count_), found_.begin());
}

}  // namespace coupler::host
