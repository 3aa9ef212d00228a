// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/sampler.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace coupler::device {

std::chrono::nanoseconds Sampler::period_for(double rate) {
  const std::chrono::duration<double> wanted(1 / rate);
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::clamp<std::chrono::duration<double>>(wanted, shortest, longest));
}

Sampler::Sampler(SysfsChannels& channels, std::chrono::nanoseconds period, std::chrono::milliseconds timeout)
    : period_(period) {
  std::map<std::string, Inputs> devices;
  for (SysfsChannels::Sampled& input : channels.inputs()) {
    input.latest.begin(TimePoint::clock::now());
    devices[input.wired.channel.device].push_back(&input);
  }
  for (const auto& [name, inputs] : devices) threads_.emplace_back([this, list = inputs] { run(list); });
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return sampled_ == threads_.size(); });
}

Sampler::~Sampler() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Sampler::run(const Inputs& of_one_device) {
  bool is_first = true;
  for (TimePoint next = TimePoint::clock::now();;) {
    for (SysfsChannels::Sampled* input : of_one_device) {
      if (stopped_) return;  // the conversions of a slow device are not waited for
      input->latest.put(input->wired.channel.read(), TimePoint::clock::now());
    }
    next = std::max(next + period_, TimePoint::clock::now());
    std::unique_lock lock(mutex_);
    if (is_first) {
      ++sampled_;
      changed_.notify_all();
    }
    is_first = false;
    if (changed_.wait_until(lock, next, [&]() -> bool { return stopped_; })) return;
  }
}

}  // namespace coupler::device
