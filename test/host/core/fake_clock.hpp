// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "coupler/host/core/clock.hpp"

namespace coupler::host::test {

/// Time passes only when somebody says so, or sleeps.
class FakeClock : public Clock {
 public:
  Time now() const override { return now_; }
  void sleep_until(Time time) override { now_ = std::max(now_, time); }
  void advance(Duration duration) { now_ += duration; }

 private:
  Time now_ = Time{} + std::chrono::hours(1);
};

}  // namespace coupler::host::test
