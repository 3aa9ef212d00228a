// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::host {

/// So many points have topics unless the setting `topics` says which. ROS 1 looks for a topic among all of a
/// node's, one after another, whenever it is made and at each message: 10,000 are made in 11 s (ROS 2: 6 s),
/// and 65,000 in minutes.
constexpr std::size_t most_points_with_topics = 10'000;

/// The points of a map that have topics.
struct ChosenPoints {
  std::vector<bool> has;              ///< by point
  std::vector<std::string> warnings;  ///< which points have none that may be wanted, and what to do
};

/// Returns the points whose names match one of the patterns, with `*` and `?` as a shell has them; `*`
/// matches '/', too. Without a pattern they are the first most_points_with_topics of the map.
ChosenPoints choose_points(const Map& map, const std::vector<std::string>& patterns);

}  // namespace coupler::host
