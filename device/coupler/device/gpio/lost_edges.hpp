// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "coupler/device/core/log.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// Says in the log that edges were lost, once per burst: a second without a loss ends it.
class LostEdges {
 public:
  /// `what` begins the sentence: "gpiochip0 line 5 (GPIO5)".
  LostEdges(std::string what, Log& log) : what_(std::move(what)), log_(&log) {}

  /// At least so many were lost just now.
  void note(std::uint32_t count, TimePoint now);

 private:
  std::string what_;
  Log* log_;
  TimePoint quiet_from_{};
};

}  // namespace coupler::device
