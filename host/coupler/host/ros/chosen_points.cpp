// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/chosen_points.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "coupler/map/name_pattern.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

ChosenPoints first_points(const Map& map) {
  ChosenPoints chosen;
  for (std::size_t i = 0; i < map.points.size(); ++i) chosen.has.push_back(i < most_points_with_topics);
  if (map.points.size() > most_points_with_topics)
    chosen.warnings.push_back(
        fmt::format("it has {} points, and only the first {} of them have topics, because ROS needs minutes "
                    "for more; say "
                    "which you need with 'topics', as in --topics 'pump_*,tank/*' ('*' for all), or join "
                    "values that belong "
                    "together in one point with 'count'",
                    map.points.size(), most_points_with_topics));
  return chosen;
}

}  // namespace

ChosenPoints choose_points(const Map& map, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return first_points(map);
  ChosenPoints chosen{std::vector<bool>(map.points.size()), {}};
  std::vector<std::string_view> names;
  for (const Point& point : map.points) names.push_back(point.name);
  for (const std::string& pattern : patterns) {
    if (!mark_matching(pattern, map.points, chosen.has))
      chosen.warnings.push_back(
          fmt::format("'topics' has {}, and no point has such a name; {}", excerpt(pattern),
                      nearest_or(pattern, names, "'coupler plan MAP' lists the points")));
  }
  const auto count = static_cast<std::size_t>(std::count(chosen.has.begin(), chosen.has.end(), true));
  if (count > most_points_with_topics)
    chosen.warnings.push_back(
        fmt::format("{} points have topics: it takes minutes until all are there, and each message takes "
                    "longer the more there "
                    "are; choose fewer with 'topics'",
                    count));
  return chosen;
}

}  // namespace coupler::host
