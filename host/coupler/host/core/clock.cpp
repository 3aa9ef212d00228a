// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/clock.hpp"

namespace coupler::host {

void SteadyClock::sleep_until(Time time) {
  std::unique_lock lock(mutex_);
  stopped_now_.wait_until(lock, time, [this] { return stopped_; });
}

void SteadyClock::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stopped_now_.notify_all();
}

}  // namespace coupler::host
