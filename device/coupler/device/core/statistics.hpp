// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// Counts since the start. The counters wrap.
struct Statistics {
  TimePoint started{};
  std::uint32_t requests = 0;                    ///< answered, exceptions included
  std::uint32_t exceptions = 0;                  ///< of those
  std::array<std::uint32_t, 4> exceptions_of{};  ///< of those, by code: 01, 02, 03, 04
  std::uint32_t hardware_errors = 0;             ///< requests that a line or channel failed, exception 04
  std::uint32_t events_lost = 0;                 ///< edges of counted inputs that were not seen, at least
  std::uint32_t watchdog_trips = 0;  ///< outputs went to their safe state since no client fed the watchdog
  std::uint32_t foreign_units = 0;   ///< requests for another unit id, not answered
  std::uint32_t connections = 0;     ///< accepted
  std::uint32_t refusals = 0;        ///< connections of clients that may not connect
  std::uint32_t evictions = 0;       ///< connections closed to make room for new ones
  std::uint32_t bad_frames = 0;      ///< connections closed for what they sent
  std::uint32_t timeouts = 0;        ///< connections closed for what they did not send or read in time
};

}  // namespace coupler::device
