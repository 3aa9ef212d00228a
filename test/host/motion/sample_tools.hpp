// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::host {

/// Two valves, and an input at each end.
constexpr Tool clamp() {
  Tool tool;
  tool.name = "clamp";
  tool.close = "valve_close";
  tool.open = "valve_open";
  tool.closed = "sensor_closed";
  tool.opened = "sensor_open";
  tool.timeout = std::chrono::milliseconds(800);
  return tool;
}

/// One output, and no input.
constexpr Tool cup() {
  Tool tool;
  tool.name = "cup";
  tool.close = "vacuum";
  tool.travel = std::chrono::milliseconds(300);
  return tool;
}

/// A device that is online, and whose values can be set.
class SampleDevice : public testing::Test {
 protected:
  explicit SampleDevice(MapPtr of_device) : map(std::move(of_device)), values(map->map()) {
    values.begin();
    values.online(true);
  }

  static Time now() { return std::chrono::steady_clock::now(); }
  std::uint32_t index(std::string_view name) const {
    return static_cast<std::uint32_t>(find(map->map(), name) - map->map().points.data());
  }
  /// The device has answered with this value of a point now, and the tools hear of it.
  void read_for(Tools& tools, std::string_view name, std::uint16_t value) {
    const std::uint32_t which = index(name);
    const Point& point = map->map().points[which];
    values.store({point.table, range(point), {which}}, {&value, 1}, {now(), {}}, now());
    tools.on_values({&which, 1}, now());
  }

  MapPtr map;
  ValueTable values;
};

}  // namespace coupler::host
