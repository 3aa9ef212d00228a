// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/published.hpp"

#include <string_view>
#include <unordered_map>

namespace coupler {

std::vector<ScaledPoint> points_with_exponent(const Map& map) {
  std::vector<ScaledPoint> result;
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (map.points[i].scale.has_exponent()) result.push_back({i, 0});
  if (result.empty()) return result;
  std::unordered_map<std::string_view, std::uint32_t> by_name;
  for (std::uint32_t i = 0; i < map.points.size(); ++i) by_name.emplace(map.points[i].name, i);
  for (ScaledPoint& each : result) each.exponent = by_name.at(map.points[each.point].scale.exponent_of);
  return result;
}

}  // namespace coupler
