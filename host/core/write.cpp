// SPDX-License-Identifier: Apache-2.0
#include "host/core/write.hpp"

#include <cassert>

namespace coupler::driver {
namespace {

Result<> write_part(const Point& point, std::uint16_t value, bool mask_write, Transport& transport) {
  const std::uint16_t mask = codec::mask(point.format);
  const auto others = static_cast<std::uint16_t>(~mask);
  if (mask_write) return transport.mask_write(point.address, others, value);
  std::uint16_t word = 0;
  if (auto read = transport.read_registers(point.table, range(point), &word); !read) return read;
  return transport.write_register(point.address,
                                  static_cast<std::uint16_t>((word & others) | (value & mask)));
}

}  // namespace

Result<> perform(const Write& write, const Map& map, Transport& transport) {
  const Point& point = map.points[write.point];
  assert(is_writable(point) && is_writable(point.table));
  if (point.table == Table::coils) return transport.write_coil(point.address, write.registers[0] != 0);
  if (is_partial(point)) return write_part(point, write.registers[0], map.limits.mask_write, transport);
  const std::uint16_t count = codec::registers(point.format);
  if (count == 1) return transport.write_register(point.address, write.registers[0]);
  return transport.write_registers(point.address, {write.registers.data(), count});
}

}  // namespace coupler::driver
