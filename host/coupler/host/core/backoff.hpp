// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The time to wait before the next attempt: 0.1 s, doubling up to 5 s.
class Backoff {
 public:
  Duration next() {
    const Duration delay = next_;
    next_ = std::min<Duration>(2 * next_, longest);
    return delay;
  }
  void reset() { next_ = shortest; }

 private:
  static constexpr Duration shortest = std::chrono::milliseconds(100);
  static constexpr Duration longest = std::chrono::seconds(5);
  Duration next_ = shortest;
};

}  // namespace coupler::host
