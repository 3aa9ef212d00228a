// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/device/core/image.hpp"

namespace coupler::device {

/// A firmware's own code behind the points that nothing else is behind (has_hardware() is false). Points are
/// indices into Map::points. All of it is called in the thread that answers clients, but for make_safe().
class Hooks {
 public:
  virtual ~Hooks() = default;

  /// This process begins to answer clients, in this thread: the place to start threads of one's own, and to
  /// open what they need. A node serves in a child process, and in another one if that dies.
  virtual void serving_began() {}

  /// Values may be set in this process.
  virtual void allow_setting() {}

  /// Puts into the image what the firmware has set since the last call.
  virtual void put_new_values(Image& image) = 0;

  /// A client writes the point: range(point).count() registers, or bits as 0 or 1. False refuses. When
  /// another point of the same request is refused, those already accepted are called again with the values
  /// they had.
  [[nodiscard]] virtual bool accept(std::uint32_t point, const std::uint16_t* registers) = 0;

  /// Nobody is in command any more: the watchdog expired, or the node ends. When the process that serves has
  /// died, it is called in another one, where serving_began() never was.
  virtual void make_safe() {}
};

}  // namespace coupler::device
