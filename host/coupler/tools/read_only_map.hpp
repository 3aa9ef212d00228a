// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::tools {

/// A map without all that a driver does to a device by itself: watchdog, on_reconnect, on_shutdown, deadman.
class ReadOnlyMap {
 public:
  /// The storage of `map` must outlive it.
  explicit ReadOnlyMap(const Map& map);
  /// The same, and all points have one rate: all of them are read once in each period.
  ReadOnlyMap(const Map& map, std::chrono::nanoseconds period);
  ReadOnlyMap(const ReadOnlyMap&) = delete;
  ReadOnlyMap& operator=(const ReadOnlyMap&) = delete;

  const Map& map() const { return map_; }

 private:
  std::vector<Point> points_;
  Map map_;
};

/// Returns the warning that reading keeps the coupler's own watchdog from expiring; empty if it does not.
std::string_view watchdog_warning(const Map& map);

}  // namespace coupler::tools
