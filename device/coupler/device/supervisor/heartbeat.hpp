// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace coupler::device {

/// Whoever wants to know that the loop which answers clients still turns.
class Heartbeat {
 public:
  /// How often it is told.
  static constexpr std::chrono::milliseconds period{200};

  virtual void beat() = 0;

 protected:
  ~Heartbeat() = default;
};

}  // namespace coupler::device
