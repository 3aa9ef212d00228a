// SPDX-License-Identifier: Apache-2.0
// The lines of a recording: one JSON object each (docs/record.md has a table of their keys). The first one of
// a file is its head.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coupler/base/span.hpp"

namespace coupler::record {

constexpr int format_version = 1;

using Nanoseconds = std::chrono::nanoseconds;

/// When something was so.
struct Moment {
  Nanoseconds since_start{};  ///< by a clock that nobody sets, since the recording began
  Nanoseconds wall{};         ///< by the wall clock, since 1970 (UTC)
};

/// The data that a file needs so that it can be played by itself.
struct Head {
  std::string name;                                                 ///< of the map
  std::string device;                                               ///< as a command takes it
  std::string fingerprint;                                          ///< of the map, 16 hexadecimal digits
  std::string map;                                                  ///< its text, without secrets
  std::vector<std::pair<std::string, double>> periods{};            ///< point, s: how often it is read
  std::vector<std::pair<std::string, std::string>> not_recorded{};  ///< point, why
  /// Point, why: what is shorter than its period, where the device does not tell its changes.
  std::vector<std::pair<std::string, std::string>> may_miss{};
};

/// Each ends with a newline. `at`: where the file begins.
std::string head_line(const Head& head, Moment at);
/// `value`: JSON. `registers`: as they stand on the wire, for what JSON cannot say; empty: bits.
std::string value_line(Moment at, std::string_view point, std::string_view value, Nanoseconds uncertainty,
                       Span<const std::uint16_t> registers, std::string_view quality = "good");
/// The device answers with an exception.
std::string no_value_line(Moment at, std::string_view point, std::string_view quality, unsigned exception);
/// `is_node`: of this project; nullopt: it was not asked.
std::string online_line(Moment at, std::optional<bool> is_node);
std::string lost_line(Moment at, std::string_view why);
/// Somebody has set the wall clock.
std::string clock_line(Moment at, Nanoseconds set_by);
/// Values in between could not be written.
std::string missing_line(Moment at, Nanoseconds since, std::string_view why);
std::string end_line(Moment at);

}  // namespace coupler::record
