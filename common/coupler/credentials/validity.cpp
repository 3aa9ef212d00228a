// SPDX-License-Identifier: Apache-2.0
#include "coupler/credentials/validity.hpp"

#include <algorithm>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace coupler {

using std::chrono::system_clock;

system_clock::time_point warns_from(const Validity& validity) {
  constexpr system_clock::duration longest_ahead = std::chrono::hours(30 * 24);
  return validity.end - std::min(longest_ahead, (validity.end - validity.begin) / 3);
}

std::optional<std::string> expiry_text(const Validity& validity, system_clock::time_point now) {
  if (now < warns_from(validity)) return std::nullopt;
  return fmt::format("{} on {}; renew it ('coupler certificates')",
                     now < validity.end ? "expires" : "has expired", minute_text(validity.end));
}

std::optional<std::string> time_problem(const Validity& validity, system_clock::time_point now) {
  if (now >= validity.begin) return expiry_text(validity, now);
  return fmt::format("begins on {}, and it is {} here; compare the clocks", minute_text(validity.begin),
                     minute_text(now));
}

std::string minute_text(system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(system_clock::to_time_t(time)));
}

}  // namespace coupler
