// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace coupler::host {

/// Which points somebody wants read: said by any thread, taken over by the connection's own.
class ReadDemand {
 public:
  void say(std::uint32_t point, bool wanted) {
    const std::lock_guard lock(mutex_);
    said_.emplace_back(point, wanted);
    any_ = true;
  }

  /// Calls f(point, wanted) for what was said since the last call, in order.
  template <class F>
  void take(F&& f) {
    if (!any_) return;
    {
      const std::lock_guard lock(mutex_);
      taken_.swap(said_);
      any_ = false;
    }
    for (const auto& [point, wanted] : taken_) f(point, wanted);
    taken_.clear();
  }

 private:
  std::atomic<bool> any_{false};
  std::mutex mutex_;
  std::vector<std::pair<std::uint32_t, bool>> said_;
  std::vector<std::pair<std::uint32_t, bool>> taken_;  ///< kept for its memory
};

}  // namespace coupler::host
