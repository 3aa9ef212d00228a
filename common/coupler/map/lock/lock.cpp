// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/lock.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace coupler::lock {
namespace {

int lowest_bit(std::uint16_t mask) {
  int bit = 0;
  while ((mask >> bit & 1) == 0) ++bit;
  return bit;
}

int part_of(const Place& place) {
  switch (place.mask) {
    case whole: return 0;
    case high_half: return 1;
    case low_half: return 2;
    default: return 3 + lowest_bit(place.mask);
  }
}

/// The address, and which half or bit of it.
std::string text_of(const Place& place) {
  const modbus::Range range = place.range;
  if (range.count() > 1) return fmt::format("{}-{}", range.start(), range.last());
  switch (place.mask) {
    case whole: return fmt::to_string(range.start());
    case high_half: return fmt::format("{}.high", range.start());
    case low_half: return fmt::format("{}.low", range.start());
    default: return fmt::format("{}.{}", range.start(), lowest_bit(place.mask));
  }
}

}  // namespace

bool less(const Place& a, const Place& b) {
  return std::tuple(index(a.table), a.range.start(), part_of(a)) <
         std::tuple(index(b.table), b.range.start(), part_of(b));
}

std::string to_string(const Place& place) {
  return fmt::format("{} {}", to_string(place.table), text_of(place));
}

bool Occupancy::is_free(const Place& place) const {
  const auto& cells = taken_[index(place.table)];
  return cells.empty() || std::all_of(cells.data() + place.range.start(), cells.data() + place.range.end(),
                                      [&](std::uint16_t cell) { return (cell & place.mask) == 0; });
}

void Occupancy::take(const Place& place) {
  auto& cells = taken_[index(place.table)];
  cells.resize(0x10000);
  std::for_each(cells.data() + place.range.start(), cells.data() + place.range.end(),
                [&](std::uint16_t& cell) { cell = static_cast<std::uint16_t>(cell | place.mask); });
}

Names::Names(const Lock& lock) {
  for (const Entry& entry : lock) of_table_[index(entry.place.table)].emplace(entry.name, &entry);
}

const Entry* Names::find(Table table, std::string_view name) const {
  const auto& names = of_table_[index(table)];
  const auto found = names.find(name);
  return found == names.end() ? nullptr : found->second;
}

bool equal(const Lock& a, const Lock& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Entry& x, const Entry& y) {
    return x.place == y.place && x.name == y.name && x.retired == y.retired;
  });
}

std::string print(const Lock& lock) {
  std::string text =
      "# The addresses that `coupler` gave to the points of the map beside this file that leave theirs out.\n"
      "# It belongs into version control, and goes wherever the map goes. `coupler check MAP` writes it. An\n"
      "# address once given never moves; that of a retired point is given to no other while its line is "
      "here.\n";
  text += fmt::format("{}\n", first_line);
  for (const Entry& entry : lock)
    text += fmt::format("{} {}{}\n", to_string(entry.place), entry.name, entry.retired ? " retired" : "");
  return text;
}

}  // namespace coupler::lock
