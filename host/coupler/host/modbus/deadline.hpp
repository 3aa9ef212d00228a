// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace coupler::host {

/// A point in time by which something must be done.
class Deadline {
 public:
  explicit Deadline(std::chrono::milliseconds after) : at_(std::chrono::steady_clock::now() + after) {}
  /// What poll() takes: milliseconds left, rounded up, 0 when it has passed.
  int left() const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(at_ - std::chrono::steady_clock::now());
    return static_cast<int>(std::max<std::chrono::milliseconds::rep>(left.count(), 0));
  }

 private:
  std::chrono::steady_clock::time_point at_;
};

}  // namespace coupler::host
