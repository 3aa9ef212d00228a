// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/timer.hpp"

#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

namespace coupler::device {
namespace {

/// A time of 0 would stop the timer.
timespec to_timespec(TimePoint at) {
  using std::chrono::nanoseconds;
  using std::chrono::seconds;
  const auto since = std::max(nanoseconds(at.time_since_epoch()), nanoseconds(1));
  const auto whole = std::chrono::duration_cast<seconds>(since);
  return {static_cast<time_t>(whole.count()), static_cast<long>((since - whole).count())};
}

}  // namespace

Timer::Timer(Loop& loop, std::function<void(TimePoint now)> on_time)
    : loop_(loop),
      timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)),
      on_time_(std::move(on_time)) {
  if (is_open() && !loop_.watch(timer_.get(), Interest::read, *this)) timer_.close();
}

Timer::~Timer() {
  if (is_open()) loop_.forget(timer_.get(), *this);
}

void Timer::set(TimePoint at) {
  if (at == std::exchange(at_, at) || !is_open()) return;
  itimerspec when{};
  if (at != TimePoint::max()) when.it_value = to_timespec(at);
  ::timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &when, nullptr);
}

void Timer::ready(TimePoint now) {
  if (now < at_) return;  // it was set anew since
  at_ = TimePoint::max();
  on_time_(now);
  std::uint64_t times = 0;  // read last, for it is late already
  [[maybe_unused]] const auto taken = ::read(timer_.get(), &times, sizeof times);
}

}  // namespace coupler::device
