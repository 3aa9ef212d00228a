// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/point.hpp"

namespace coupler::host {

/// Whether a value that was read is news for those who listen: every one under `publish: always`; under
/// `on_change` one that differs from the last news by more than the deadband, one that comes max_interval
/// after it, and the first one after renew(). Allocates nothing once it is made.
class PublishPolicy {
 public:
  /// The point must outlive it.
  explicit PublishPolicy(const Point& point);

  /// The point's registers as they came `at`; bit tables: each bit as one register, 0 or 1.
  bool calls_news(const std::uint16_t* registers, Time at);

  /// When the value that was news last is so again. Time::max(): never.
  Time repeat_at() const;

  /// The next value is news whatever it is: the device was away, or a new listener has not seen the last one.
  /// From any thread.
  void renew() { renewed_ = true; }

 private:
  bool differs(const std::uint16_t* registers) const;

  const Point& point_;
  std::vector<std::uint16_t> last_;  ///< what was news last
  Time last_at_{};
  std::atomic<bool> renewed_{true};
};

}  // namespace coupler::host
