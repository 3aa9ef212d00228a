// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/name_pattern.hpp"

#include <fnmatch.h>

#include <cstddef>
#include <string>

namespace coupler {

bool matches(std::string_view pattern, std::string_view name) {
  return ::fnmatch(std::string(pattern).c_str(), std::string(name).c_str(), 0) == 0;
}

bool mark_matching(std::string_view pattern, Span<const Point> points, std::vector<bool>& marked) {
  bool found = false;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (matches(pattern, points[i].name)) found = marked[i] = true;
  return found;
}

}  // namespace coupler
