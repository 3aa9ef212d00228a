// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/time.hpp"
#include "coupler/modbus/node_time.hpp"

namespace coupler::device {

/// Tells what time it is while something is carried out. Others use the time at which their turn began.
class Clock {
 public:
  virtual TimePoint now() const = 0;

 protected:
  ~Clock() = default;
};

/// Returns a time in the form that PDUs have.
inline modbus::NodeTime node_time(TimePoint at) {
  return std::chrono::duration_cast<modbus::NodeTime>(at.time_since_epoch());
}

}  // namespace coupler::device
