// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace coupler::device {

/// The moment that a text names: ISO 8601, as 2026-11-24T15:00:00Z or without the Z in local time; or a local
/// time of the day of `first`, as 15:00 or 15:00:12.5. Since 1970; nullopt: it is none of these.
std::optional<std::chrono::nanoseconds> parse_moment(const std::string& text, std::chrono::nanoseconds first);

}  // namespace coupler::device
