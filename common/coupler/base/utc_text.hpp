// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>
#include <string>

#include <fmt/chrono.h>

namespace coupler {

/// "2026-11-21T13:20:11.123Z" (ISO 8601), rounded down.
inline std::string utc_text(std::chrono::system_clock::time_point time) {
  using std::chrono::milliseconds;
  const auto since = std::chrono::floor<milliseconds>(time.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  return fmt::format("{:%FT%T}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(seconds.count())),
                     (since - seconds).count());
}

inline std::string utc_text(std::chrono::nanoseconds since_1970) {
  using std::chrono::system_clock;
  return utc_text(system_clock::time_point(std::chrono::floor<system_clock::duration>(since_1970)));
}

}  // namespace coupler
