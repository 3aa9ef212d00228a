// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace coupler::host {

/// How many listen to each point of a device. Any thread may call.
class Listeners {
 public:
  explicit Listeners(std::size_t points) : counts_(points) {}

  void came(std::uint32_t point) {
    const std::lock_guard lock(mutex_);
    if (counts_[point]++ == 0 && want_) want_(point, true);
  }
  void left(std::uint32_t point) {
    const std::lock_guard lock(mutex_);
    if (--counts_[point] == 0 && want_) want_(point, false);
  }

  /// `want(point, true)` is called for each point that somebody listens to, and from now on `want` when the
  /// first one comes and when the last one has left. It must wait for nothing.
  void follow(std::function<void(std::uint32_t point, bool wanted)> want) {
    const std::lock_guard lock(mutex_);
    want_ = std::move(want);
    for (std::uint32_t point = 0; point < counts_.size(); ++point)
      if (counts_[point] > 0) want_(point, true);
  }

  /// Nobody listens to it, and somebody minds.
  bool is_unwanted(std::uint32_t point) const {
    const std::lock_guard lock(mutex_);
    return want_ && counts_[point] == 0;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::uint32_t> counts_;
  std::function<void(std::uint32_t, bool)> want_;
};

}  // namespace coupler::host
