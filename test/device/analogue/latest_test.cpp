// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/latest.hpp"

#include <gtest/gtest.h>

namespace coupler::device {
namespace {

using Sample = tl::expected<double, int>;

struct LatestSample : testing::Test {
  LatestSample() { latest.begin(now); }
  TimePoint now{std::chrono::hours(1)};
  Latest latest;
};

TEST_F(LatestSample, Is_not_there_before_the_first_conversion) {
  EXPECT_EQ(Sample(tl::unexpected(EAGAIN)), latest.get(now));
}

TEST_F(LatestSample, Is_the_last_one) {
  latest.put(1.5, now);
  latest.put(2.5, now);
  EXPECT_EQ(Sample(2.5), latest.get(now));
}

TEST_F(LatestSample, That_failed_is_an_error_until_one_succeeds) {
  latest.put(1.5, now);
  latest.put(tl::unexpected(EIO), now);
  EXPECT_EQ(Sample(tl::unexpected(EIO)), latest.get(now));
  latest.put(2.5, now);
  EXPECT_EQ(Sample(2.5), latest.get(now));
}

TEST_F(LatestSample, Is_an_error_when_no_other_came_for_too_long) {
  latest.put(1.5, now);
  EXPECT_EQ(Sample(1.5), latest.get(now + Latest::timeout));
  const TimePoint late = now + Latest::timeout + std::chrono::milliseconds(1);
  EXPECT_EQ(Sample(tl::unexpected(ETIMEDOUT)), latest.get(late));
  latest.begin(late);
  EXPECT_EQ(Sample(tl::unexpected(EAGAIN)), latest.get(late));
}

}  // namespace
}  // namespace coupler::device
