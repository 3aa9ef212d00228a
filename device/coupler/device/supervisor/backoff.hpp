// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace coupler::device {

/// The pause before a process that ended is started again: doubled each time, short again after one that
/// lived long enough.
class Backoff {
 public:
  static constexpr std::chrono::milliseconds shortest{100};
  static constexpr std::chrono::milliseconds longest{5000};
  static constexpr std::chrono::seconds long_enough{10};

  std::chrono::milliseconds after(std::chrono::nanoseconds lived) {
    if (lived >= long_enough) next_ = shortest;
    const auto pause = next_;
    next_ = std::min(2 * next_, longest);
    return pause;
  }

 private:
  std::chrono::milliseconds next_ = shortest;
};

}  // namespace coupler::device
