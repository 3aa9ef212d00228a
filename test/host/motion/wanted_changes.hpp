// SPDX-License-Identifier: Apache-2.0
// What a trajectory asks of the axes of SampleJoints, by a computation that shares nothing with
// trajectory_plan.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "coupler/host/motion/trajectory_plan.hpp"

namespace coupler::host {

/// The axes of SampleJoints, with what their points have at the positions in ascending order; none: the
/// position.
struct SampleAxis {
  const char* name;
  const char* point;
  double highest;
  std::vector<std::pair<double, std::uint16_t>> stops;
};
inline const std::array<SampleAxis, 3> sample_axes{{{"glue", "valve_glue", 1, {{0, 0}, {1, 1}}},
                                                    {"mode", "mode", 4, {{0, 0}, {1, 7}, {4, 2}}},
                                                    {"speed", "speed", 9, {}}}};

/// A change that the straight lines between the points ask for.
struct Wanted {
  Duration at{};
  std::size_t axis = 0;
  std::uint16_t value = 0;
  bool is_made = false;
};

/// Adds the changes of the joint `i` of the goal.
inline void add_wanted(const TrajectoryGoal& goal, std::size_t i, std::size_t axis,
                       std::vector<Wanted>& all) {
  const auto& stops = sample_axes[axis].stops;
  std::optional<std::uint16_t> has;
  const auto add = [&](Duration at, std::uint16_t value) {
    if (has != value) all.push_back({at, axis, value});
    has = value;
  };
  const TrajectoryGoal::Waypoint* before = &goal.points.front();
  for (const TrajectoryGoal::Waypoint& point : goal.points) {
    const double from = before->positions[i], to = point.positions[i];
    if (stops.empty()) add(point.from_start, static_cast<std::uint16_t>(std::lround(to)));
    std::vector<std::pair<double, std::uint16_t>>
        crossed;  // after a part of the way, and the value from then on
    std::uint16_t nearest = stops.empty() ? 0 : stops[0].second;
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      const double middle = (stops[s].first + stops[s + 1].first) / 2;
      if (to >= middle) nearest = stops[s + 1].second;
      if ((from < middle) != (to < middle))
        crossed.emplace_back((middle - from) / (to - from), stops[to < middle ? s : s + 1].second);
    }
    if (!stops.empty() && !has) add(point.from_start, nearest);
    std::sort(crossed.begin(), crossed.end());
    const std::chrono::duration<double, std::nano> length(point.from_start - before->from_start);
    for (const auto& [part, value] : crossed)
      add(before->from_start + std::chrono::duration_cast<Duration>(part * length), value);
    before = &point;
  }
}

}  // namespace coupler::host
