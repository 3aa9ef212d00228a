// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "coupler/device/core/log.hpp"

namespace coupler::device {

/// Whether some hardware works, said in the log once per change. Clients can cause changes by what they
/// write, so the log limits these lines.
class Fault {
 public:
  /// `what` begins the sentence: "gpiochip0 line 5 (GPIO5)". `error` is the last outcome, which processes
  /// that use the same hardware share.
  Fault(std::string what, int& error, Log& log) : what_(std::move(what)), error_(&error), log_(&log) {}

  /// The outcome of a call: 0 or an errno. Returns whether it was good.
  bool note(int error);

 private:
  std::string what_;
  int* error_;
  Log* log_;
};

}  // namespace coupler::device
