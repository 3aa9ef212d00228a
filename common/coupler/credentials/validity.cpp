// SPDX-License-Identifier: Apache-2.0
#include "coupler/credentials/validity.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>

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

/// Without std::time_t, which ends in 2038 where it has 32 bits. The calendar is that of eras of 400 years
/// from March on, whose leap day is the last one.
std::string minute_text(system_clock::time_point time) {
  using std::chrono::minutes;
  const std::int64_t total = std::chrono::floor<minutes>(time.time_since_epoch()).count();
  constexpr std::int64_t a_day = 1440;           // minutes
  constexpr std::int64_t before_1970 = 719'468;  // days since 0000-03-01
  const std::int64_t days = total / a_day + before_1970;
  const std::int64_t era = days / 146'097;
  const std::int64_t of_era = days % 146'097;
  const std::int64_t year_of_era = (of_era - of_era / 1460 + of_era / 36'524 - of_era / 146'096) / 365;
  const std::int64_t of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t month_from_march = (5 * of_year + 2) / 153;
  const std::int64_t day = of_year - (153 * month_from_march + 2) / 5 + 1;
  const std::int64_t month = month_from_march < 10 ? month_from_march + 3 : month_from_march - 9;
  const std::int64_t year = year_of_era + era * 400 + (month <= 2 ? 1 : 0);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", year, month, day, total % a_day / 60, total % 60);
}

}  // namespace coupler
