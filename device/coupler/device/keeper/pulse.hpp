// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace coupler::device {

/// Whoever wants to know that the loop which answers masters still turns.
class Pulse {
 public:
  /// How often it is told.
  static constexpr std::chrono::milliseconds period{200};

  virtual void beat() = 0;

 protected:
  ~Pulse() = default;
};

}  // namespace coupler::device
