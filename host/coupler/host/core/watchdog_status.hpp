// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace coupler::host {

/// How it stands with the watchdog that the coupler has of its own.
struct WatchdogStatus {
  enum class State : std::uint8_t {
    not_fed,  ///< not connected, or it could not be armed
    fed,      ///< armed, where the coupler lets the host do that
    expired   ///< outputs are as the coupler leaves them then
  };
  State state = State::not_fed;
  std::uint64_t expiries = 0;  ///< that were noticed
  std::string trouble;         ///< what is wrong and what to do, while it is expired or could not be armed
};

}  // namespace coupler::host
