// SPDX-License-Identifier: Apache-2.0
// The lock of a map: which addresses were given to the points that leave theirs out (docs/map.md, "Addresses
// left out").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::lock {

constexpr std::uint16_t whole = 0xFFFF;
constexpr std::uint16_t high_half = 0xFF00;
constexpr std::uint16_t low_half = 0x00FF;

/// The place of a point: whole addresses of a table, or some bits of one register, as they are on the wire.
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

/// Returns the place as a line of the lock has it: "holding_registers 5", "… 5-8", "… 5.high", "… 5.low",
/// "… 5.3" (bit 3).
std::string to_string(const Place& place);

/// The bits of all tables that are taken.
class Occupancy {
 public:
  bool is_free(const Place& place) const;
  void take(const Place& place);

 private:
  std::array<std::vector<std::uint16_t>, tables.size()> taken_;  ///< empty: nothing is
};

/// One line of a lock.
struct Entry {
  Place place;           ///< reserved for the point, which may need less than it did
  std::string name;      ///< of the point; a name is once in a table
  bool retired = false;  ///< no point of the map has the place now, and no other gets it
  int line = 0;          ///< in the file, from 1; 0: not in a file yet
};

/// Sorted by place; no two places overlap.
using Lock = std::vector<Entry>;

/// The entries of a lock, which must outlive it, by name.
class Names {
 public:
  explicit Names(const Lock& lock);
  /// nullptr if there is none.
  const Entry* find(Table table, std::string_view name) const;

 private:
  std::array<std::unordered_map<std::string_view, const Entry*>, tables.size()> of_table_;
};

/// Both hold the same, wherever it stands.
bool equal(const Lock& a, const Lock& b);

struct Parsed {
  Lock lock;  ///< empty if there are errors
  Diagnostics diagnostics;
};

/// Reads a lock. Every problem is reported; `file` names it in the diagnostics.
Parsed parse(std::string_view text, std::string_view file);

/// The beginning of a lock, before its entries.
constexpr std::string_view first_line = "coupler lock 1";

/// The file. It depends on nothing but the lock.
std::string print(const Lock& lock);

}  // namespace coupler::lock
