// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/shutdown_summary.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

namespace coupler::device {
namespace {

/// " (01: 2, 03: 1)"; nothing if there were none.
std::string by_code(const Statistics& statistics) {
  std::string text;
  for (std::size_t i = 0; i < statistics.exceptions_of.size(); ++i)
    if (const auto count = statistics.exceptions_of[i]; count != 0)
      text += fmt::format("{}{:02}: {}", text.empty() ? " (" : ", ", i + 1, count);
  return text.empty() ? text : text + ")";
}

}  // namespace

std::string shutdown_summary(int signal, bool safe, const Statistics& statistics, TimePoint now) {
  struct Count {
    std::string_view of;
    std::uint32_t count;
  };
  std::string text = fmt::format(
      "{}: {}; answered {} requests, {} of them with an exception{}; uptime {} s", ::strsignal(signal),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
      statistics.requests, statistics.exceptions, by_code(statistics),
      std::chrono::duration_cast<std::chrono::seconds>(now - statistics.started).count());
  for (const Count& item : {Count{"connections", statistics.connections},
                            {"refused", statistics.refusals},
                            {"evicted", statistics.evictions},
                            {"closed for what they sent", statistics.bad_frames},
                            {"timed out", statistics.timeouts},
                            {"requests for other units", statistics.foreign_units},
                            {"hardware errors", statistics.hardware_errors},
                            {"events lost", statistics.events_lost},
                            {"watchdog trips", statistics.watchdog_trips}})
    if (item.count != 0) text += fmt::format(", {}: {}", item.of, item.count);
  return text;
}

}  // namespace coupler::device
