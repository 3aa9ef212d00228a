// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Says how far a long start is: ROS 1's master is told of each topic and each service, one after another,
/// and that takes minutes for tens of thousands of points.
class StartProgress {
 public:
  static constexpr std::chrono::seconds period{5};

  /// `what` the points have or do, once it is done: "have their topics".
  StartProgress(std::size_t points, std::string_view what, Time now)
      : points_(points), what_(what), said_(now) {}

  /// Returns "12000 of 65000 points have their topics", once in a period and not for the last one.
  std::optional<std::string> at(std::size_t done, Time now) {
    if (now - said_ < period || done == points_) return std::nullopt;
    said_ = now;
    return fmt::format("{} of {} points {}", done, points_, what_);
  }

 private:
  std::size_t points_;
  std::string_view what_;
  Time said_;
};

/// Calls `act` with the number of each point of the map, and logs how far that is. A signal ends it.
template <class Act>
void for_each_point(Node& node, const Map& map, std::string_view what, const Act& act) {
  StartProgress progress(map.points.size(), what, std::chrono::steady_clock::now());
  for (std::uint32_t i = 0; i < map.points.size() && !Shutdown::requested; ++i) {
    act(i);
    if (const auto line = progress.at(i + 1, std::chrono::steady_clock::now()))
      node.log(Level::info, fmt::format("{}: {}", map.name, *line));
  }
}

}  // namespace coupler::host
