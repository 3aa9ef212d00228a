// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/rights_text.hpp"

namespace coupler {

std::string rights_text(const Map& map, const Role& role, Right right) {
  std::string names;
  bool is_all = true;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    const bool is_possible = right == Right::read ? is_readable(point) : is_writable(point);
    if (role.may(right, i))
      names.append(names.empty() ? "" : ", ").append(point.name);
    else
      is_all = is_all && !is_possible;
  }
  if (names.empty()) return "none";
  return is_all ? "all" : names;
}

std::string_view plain_clients(const Security& security) {
  return security.files.present() ? "clients without TLS" : "every client";
}

}  // namespace coupler
