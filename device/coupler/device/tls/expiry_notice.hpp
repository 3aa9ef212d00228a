// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "coupler/credentials/validity.hpp"
#include "coupler/device/core/log.hpp"

namespace coupler::device {

/// Tells in the log that the node's certificate ends or has ended (expiry_text()), once a day.
class ExpiryNotice {
 public:
  using WallTime = std::chrono::system_clock::time_point;

  explicit ExpiryNotice(Log& log) : log_(log) {}

  /// From now on that of this certificate. The next tick() tells it, if it is time.
  void watch(const Validity& validity) {
    validity_ = validity;
    due_ = TimePoint::min();
  }
  /// How long tick() need not be called; nullopt: there is no certificate.
  std::optional<std::chrono::milliseconds> time_until_due(TimePoint now) const;
  void tick(TimePoint now, WallTime wall_time);

 private:
  Log& log_;
  std::optional<Validity> validity_;
  TimePoint due_{};
};

}  // namespace coupler::device
