// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/map.hpp"

#include <algorithm>
#include <tuple>

namespace coupler {
namespace {

/// Half or bit: whole registers first, then by their place.
unsigned part(const Point& point) {
  if (!is_partial(point)) return 0;
  if (point.format.type == codec::Type::BOOL) return 3U + point.format.bit;
  return point.format.half == codec::Half::high ? 1 : 2;
}

auto key(const Point& point) {
  return std::make_tuple(index(point.table), point.address, part(point), point.name);
}

}  // namespace

const Point* find(const Map& map, std::string_view name) {
  const auto* found =
      std::find_if(map.points.begin(), map.points.end(), [&](const Point& p) { return p.name == name; });
  return found == map.points.end() ? nullptr : found;
}

bool canonical_less(const Point& a, const Point& b) { return key(a) < key(b); }

}  // namespace coupler
