// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cerrno>
#include <chrono>
#include <tl/expected.hpp>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The newest sample of an input: one thread stores it, another one reads it, and neither waits.
class LatestSample {
 public:
  /// An input without a sample for so long counts as broken: its chip, or its bus, hangs.
  static constexpr std::chrono::seconds timeout{10};

  /// Sampling begins.
  void begin(TimePoint now) {
    taken_ = now;
    error_ = EAGAIN;
  }

  void put(const tl::expected<double, int>& sample, TimePoint now) {
    if (sample) value_ = *sample;
    taken_ = now;
    error_ = sample ? 0 : sample.error();
  }

  /// The error is an errno. EAGAIN: there is none yet; ETIMEDOUT: it is too old.
  tl::expected<double, int> get(TimePoint now) const {
    const int error = error_;
    if (now - taken_.load() > timeout) return tl::unexpected(ETIMEDOUT);
    if (error != 0) return tl::unexpected(error);
    return value_.load();
  }

 private:
  std::atomic<double> value_{0};
  std::atomic<TimePoint> taken_{TimePoint::max()};  ///< or begun
  std::atomic<int> error_{EAGAIN};
};

}  // namespace coupler::device
