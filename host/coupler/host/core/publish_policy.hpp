// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/point.hpp"

namespace coupler::host {

/// Decides whether a value that was read is published: each value under `publish: always`; under `on_change`
/// a value that differs from the last published one by more than the deadband, one that comes max_interval
/// after it, and the first one after renew(). Once it is made, it allocates no memory.
class PublishPolicy {
 public:
  /// The point must outlive the policy.
  explicit PublishPolicy(const Point& point);

  /// `registers` has the point's host_registers(), or its bits as 0 or 1, as they were at the time `at`.
  bool calls_news(const std::uint16_t* registers, Time at);

  /// The time at which the last published value is published again; Time::max(): never.
  Time repeat_at() const;

  /// The next value is published, whatever it is, because the device was away or a new reader has not seen
  /// the last one. Any thread may call it.
  void renew() { renewed_ = true; }

 private:
  bool differs(const std::uint16_t* registers) const;

  const Point& point_;
  std::vector<std::uint16_t> last_;  ///< the last published value
  Time last_at_{};
  std::atomic<bool> renewed_{true};
};

}  // namespace coupler::host
