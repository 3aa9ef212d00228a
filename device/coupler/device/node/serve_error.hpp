// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/device/core/log.hpp"

namespace coupler::device {

/// Why a map is not served.
struct ServeError {
  /// A wrong map stays wrong; what failed may work the next time, so a service is started again then.
  enum Reason : int { map_is_wrong = 1, device_failed = 3 };
  Reason reason;               ///< also the exit status
  std::string errors;          ///< one a line; empty: they are logged already
  std::string first_logged{};  ///< of those
};

/// Logs each of the errors.
void log_errors(Log& log, const ServeError& error);

}  // namespace coupler::device
