// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::lock {

constexpr std::uint16_t whole = 0xFFFF;
constexpr std::uint16_t high_half = 0xFF00;
constexpr std::uint16_t low_half = 0x00FF;

/// Where a point stands: whole addresses of a table, or some bits of one register, as they are on the wire.
struct Place {
  Table table = Table::coils;
  modbus::Range range = modbus::Range::of(0, 1);
  std::uint16_t mask = whole;
};

constexpr bool operator==(const Place& a, const Place& b) {
  return a.table == b.table && a.range == b.range && a.mask == b.mask;
}
constexpr bool overlap(const Place& a, const Place& b) {
  return a.table == b.table && a.range.overlaps(b.range) && (a.mask & b.mask) != 0;
}

/// By table, address and part: whole, high, low, bit 0 … 15.
bool less(const Place& a, const Place& b);

/// The part of a lock's line that follows the table: "5", "5-8", "5.high", "5.low", "5.3" (bit 3).
std::string text_of(const Place& place);

/// "holding_registers 5-8".
std::string to_string(const Place& place);

/// The bits of all tables that are somebody's.
class Occupancy {
 public:
  bool is_free(const Place& place) const;
  void take(const Place& place);

 private:
  std::array<std::vector<std::uint16_t>, tables.size()> taken_;  ///< empty: nothing is
};

}  // namespace coupler::lock
