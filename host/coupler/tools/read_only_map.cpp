// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/read_only_map.hpp"

namespace coupler::tools {

ReadOnlyMap::ReadOnlyMap(const Map& map) : points_(map.points.begin(), map.points.end()), map_(map) {
  for (Point& point : points_) point.host.deadman = {};
  map_.points = {points_.data(), points_.size()};
  map_.coupler_watchdog = {};
  map_.on_reconnect = OnReconnect::drop;
  map_.on_shutdown = OnShutdown::hold;
  map_.poll = Poll::all;
}

ReadOnlyMap::ReadOnlyMap(const Map& map, std::chrono::nanoseconds period) : ReadOnlyMap(map) {
  for (Point& point : points_) {
    point.host.rate = 0;
    point.host.publish = HostOptions::Publish::always;
  }
  map_.polling.rate = 1 / std::chrono::duration<double>(period).count();
}

std::string_view watchdog_warning(const Map& map) {
  if (!map.coupler_watchdog.present() || !map.coupler_watchdog.feed.empty()) return {};
  return "every request feeds the watchdog of this coupler: while this program reads, it does not expire";
}

}  // namespace coupler::tools
