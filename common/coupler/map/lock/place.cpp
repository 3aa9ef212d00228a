// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/place.hpp"

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

}  // namespace

bool less(const Place& a, const Place& b) {
  return std::tuple(index(a.table), a.range.start(), part_of(a)) <
         std::tuple(index(b.table), b.range.start(), part_of(b));
}

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

}  // namespace coupler::lock
