// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "coupler/device/core/log.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The state of hardware that works or fails. Each change is logged once. Clients can cause changes by their
/// writes, so the log limits these lines.
class Fault {
 public:
  /// `what` begins the sentence: "gpiochip0 line 5 (GPIO5)". `error` is the last outcome; processes that use
  /// the same hardware share it.
  Fault(std::string what, int& error, Log& log) : what_(std::move(what)), error_(&error), log_(&log) {}

  /// The outcome of a call: 0 or an errno. Returns whether it was good.
  bool note(int error);
  /// The last outcome.
  int error() const { return *error_; }

 private:
  std::string what_;
  int* error_;
  Log* log_;
};

/// Logs that edges were lost, once per burst: a second without a loss ends it.
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
