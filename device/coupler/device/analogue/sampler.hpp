// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "coupler/device/analogue/sysfs_channels.hpp"

namespace coupler::device {

/// Reads inputs over and over, with one thread for each device, so that a conversion keeps nobody waiting who
/// asks for its value. Belongs into the process that answers clients: threads are not inherited.
class Sampler {
 public:
  /// How often a device is read at most, and at least, whatever the map's rate.
  static constexpr std::chrono::milliseconds shortest{5};
  static constexpr std::chrono::milliseconds longest{1000};
  /// How long the first samples are waited for, unless somebody says otherwise.
  static constexpr std::chrono::milliseconds first{200};

  /// The period of a map that is polled at `rate` Hz.
  static std::chrono::nanoseconds period_for(double rate);

  /// `channels` outlive it.
  Sampler(SysfsChannels& channels, std::chrono::nanoseconds period,
          std::chrono::milliseconds timeout = first);
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;
  /// Waits for the conversions that are under way.
  ~Sampler();

 private:
  using Inputs = std::vector<SysfsChannels::Sampled*>;
  void run(const Inputs& of_one_device);

  std::chrono::nanoseconds period_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t sampled_ = 0;  ///< devices that were read once
  std::atomic<bool> stopped_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace coupler::device
