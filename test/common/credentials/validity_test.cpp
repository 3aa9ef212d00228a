// SPDX-License-Identifier: Apache-2.0
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

}  // namespace
}  // namespace coupler
