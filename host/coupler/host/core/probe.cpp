// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/probe.hpp"

#include <algorithm>
#include <array>

#include "coupler/modbus/limits.hpp"

namespace coupler::host {
namespace {

Result<> read(Table table, modbus::Range range, Transport& transport) {
  if (holds_bits(table)) {
    std::array<std::uint8_t, modbus::max_read_bits> bits;
    return transport.read_bits(table, range, bits.data());
  }
  std::array<std::uint16_t, modbus::max_read_registers> registers;
  return transport.read_registers(table, range, registers.data());
}

}  // namespace

Result<> probe(const Map& map, Transport& transport) {
  const auto found = std::find_if(map.points.begin(), map.points.end(), is_readable);
  const Point* const asked = found == map.points.end() ? map.points.begin() : found;
  Result<> answer = map.points.empty() ? read(Table::coils, modbus::Range::of(0, 1), transport)
                                       : read(asked->table, read_range(*asked), transport);
  if (answer || (exception_in(answer.error()) != nullptr && !is_unit_away(answer.error()))) return {};
  return answer;
}

}  // namespace coupler::host
