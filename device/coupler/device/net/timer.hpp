// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "coupler/device/net/loop.hpp"

namespace coupler::device {

/// Calls back at a point in time, never before it, more exactly than Loop's time-out in milliseconds
/// (timerfd).
class Timer : public EventHandler {
 public:
  /// Both outlive it. `on_time` does not call set().
  Timer(Loop& loop, std::function<void(TimePoint now)> on_time);
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  ~Timer();

  /// False: the kernel had no descriptor left for it.
  bool is_open() const { return timer_.is_open(); }
  /// In place of the time before; TimePoint::max(): never.
  void set(TimePoint at);

  void ready(TimePoint now) override;

 private:
  Loop& loop_;
  Descriptor timer_;
  std::function<void(TimePoint now)> on_time_;
  TimePoint at_ = TimePoint::max();
};

}  // namespace coupler::device
