// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/credentials/validity.hpp"

namespace coupler {
namespace {

using std::chrono::hours;
using std::chrono::seconds;
using std::chrono::system_clock;
using testing::Optional;

constexpr system_clock::time_point start{seconds(1'795'651'200)};  // 2026-11-26 00:00 UTC
constexpr hours day(24);

TEST(Validity, A_long_life_is_warned_of_thirty_days_before_its_end) {
  const Validity two_years{start, start + 730 * day};
  EXPECT_EQ(warns_from(two_years), start + 700 * day);
  EXPECT_EQ(expiry_text(two_years, start + 700 * day - seconds(1)), std::nullopt);
  EXPECT_THAT(expiry_text(two_years, start + 700 * day),
              Optional(std::string("expires on 2028-11-25 00:00 UTC; renew it ('coupler certificates')")));
}

TEST(Validity, A_short_life_is_warned_of_in_its_last_third) {
  EXPECT_EQ(warns_from({start, start + 9 * day}), start + 6 * day);
}

TEST(Validity, At_its_end_it_has_expired) {
  EXPECT_THAT(
      expiry_text({start, start + day}, start + day),
      Optional(std::string("has expired on 2026-11-27 00:00 UTC; renew it ('coupler certificates')")));
}

TEST(Validity, Before_its_beginning_the_clocks_are_to_be_compared) {
  const Validity a_day{start, start + day};
  EXPECT_THAT(
      time_problem(a_day, start - hours(1)),
      Optional(std::string("begins on 2026-11-26 00:00 UTC, and it is 2026-11-25 23:00 UTC here; compare the "
                           "clocks")));
  EXPECT_EQ(time_problem(a_day, start), std::nullopt);
  EXPECT_EQ(time_problem(a_day, start + day), expiry_text(a_day, start + day));
}

TEST(MinuteText, Is_right_for_each_day_that_the_clock_knows) {
  using std::chrono::seconds;
  using Time = std::chrono::system_clock::time_point;
  const auto last = std::chrono::duration_cast<seconds>(Time::duration::max());
  for (const auto& [since, text] :
       {std::pair(seconds(0), "1970-01-01 00:00 UTC"),
        std::pair(seconds(951'868'799), "2000-02-29 23:59 UTC"),
        std::pair(seconds(951'868'800), "2000-03-01 00:00 UTC"),
        std::pair(seconds(2'147'483'648), "2038-01-19 03:14 UTC"),
        std::pair(seconds(4'107'542'399), "2100-02-28 23:59 UTC"),
        std::pair(seconds(4'107'542'400), "2100-03-01 00:00 UTC"), std::pair(last, "2262-04-11 23:47 UTC")})
    EXPECT_EQ(minute_text(Time(since)), text);
  for (auto time = Time(); time < Time(last - 13 * day); time += 13 * day)
    ASSERT_EQ(minute_text(time),
              fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(time))));
}

}  // namespace
}  // namespace coupler
