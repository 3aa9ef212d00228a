// SPDX-License-Identifier: Apache-2.0
// The lock of a map: which addresses were given to the points that leave theirs out (docs/map.md, "Addresses
// left out").
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/lock/place.hpp"

namespace coupler::lock {

/// One line of a lock.
struct Entry {
  Place place;           ///< the room of the point: the point may need less than it did
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

/// What a lock says before its entries.
constexpr std::string_view first_line = "coupler lock 1";

/// The file. It depends on nothing but the lock.
std::string print(const Lock& lock);

}  // namespace coupler::lock
