// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "coupler/map/map.hpp"

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

}  // namespace coupler::host
