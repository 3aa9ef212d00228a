// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/wall_time.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

/// Both clocks, at instants that the test says.
struct WallTimeTest : testing::Test {
  /// The wall clock is read in the middle of `takes`.
  Duration measure(Duration takes) {
    const Duration set_by = wall.measure(now, now.time_since_epoch() + takes / 2 + ahead, now + takes);
    now += takes;
    return set_by;
  }

  Time now = Time{} + hours(5);
  nanoseconds ahead = hours(24 * 365);  ///< the wall clock
  WallTime wall;
};

TEST_F(WallTimeTest, It_is_the_wall_clocks_time_at_an_instant_of_the_monotonic_one) {
  measure(nanoseconds(40));
  EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead);
  EXPECT_EQ(wall.of(now - milliseconds(7)), now.time_since_epoch() + ahead - milliseconds(7));
  EXPECT_EQ(wall.error(), nanoseconds(20));
}

TEST_F(WallTimeTest, A_step_of_the_wall_clock_is_followed) {
  measure(nanoseconds(40));
  for (const nanoseconds step : {nanoseconds(hours(1)), nanoseconds(hours(-3)), nanoseconds(500)}) {
    ahead += step;
    measure(nanoseconds(60));
    EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead);
  }
}

TEST_F(WallTimeTest, Who_sets_the_clock_is_told) {
  EXPECT_EQ(measure(nanoseconds(40)), Duration::zero());
  for (const nanoseconds step : {nanoseconds(hours(1)), nanoseconds(milliseconds(-60))}) {
    const std::uint32_t before = wall.times_set();
    ahead += step;
    now += hours(1);  // however long ago the last measurement was
    EXPECT_EQ(measure(nanoseconds(40)), step);
    EXPECT_EQ(wall.times_set(), before + 1);
    EXPECT_EQ(measure(nanoseconds(40)), Duration::zero()) << "once";
    EXPECT_EQ(wall.times_set(), before + 1);
  }
  ahead += milliseconds(40);
  EXPECT_EQ(measure(nanoseconds(40)), Duration::zero());
  EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead) << "it is followed";
}

TEST_F(WallTimeTest, A_better_measurement_is_nobody_who_sets_the_clock) {
  ahead += milliseconds(140);  // read near the end of a long pause
  measure(milliseconds(300));
  ahead -= milliseconds(140);
  EXPECT_EQ(measure(nanoseconds(40)), Duration::zero());
  EXPECT_EQ(wall.times_set(), 0U);
  EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead);
}

TEST_F(WallTimeTest, It_does_not_tremble_with_each_measurement) {
  measure(nanoseconds(40));
  const nanoseconds first = wall.of(now);
  const Time at = now;
  ahead += nanoseconds(15);  // the wall clock is read a little later
  measure(nanoseconds(60));
  EXPECT_EQ(wall.of(at), first);
}

TEST_F(WallTimeTest, A_measurement_that_was_interrupted_changes_nothing) {
  measure(nanoseconds(40));
  ahead += milliseconds(4);  // read at the end of a long pause
  measure(milliseconds(10));
  ahead -= milliseconds(4);
  EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead);
  EXPECT_EQ(wall.error(), nanoseconds(20));
}

TEST_F(WallTimeTest, A_better_measurement_takes_the_place_of_an_interrupted_one) {
  ahead += milliseconds(4);
  measure(milliseconds(10));
  EXPECT_EQ(wall.error(), milliseconds(5));
  ahead -= milliseconds(4);
  measure(nanoseconds(40));
  EXPECT_EQ(wall.of(now), now.time_since_epoch() + ahead);
  EXPECT_EQ(wall.error(), nanoseconds(20));
}

TEST_F(WallTimeTest, It_measures_the_machines_clocks) {
  wall.measure();
  const Time before = std::chrono::steady_clock::now();
  const nanoseconds said = std::chrono::system_clock::now().time_since_epoch();
  const Time after = std::chrono::steady_clock::now();
  EXPECT_GE(said, wall.of(before) - wall.error());
  EXPECT_LE(said, wall.of(after) + wall.error());
}

TEST_F(WallTimeTest, Two_agree_unless_somebody_has_set_the_wall_clock_in_between) {
  measure(nanoseconds(40));
  const WallTime before = std::exchange(wall, WallTime());
  EXPECT_FALSE(before.agrees_with(wall));  // it knows nothing
  ahead += nanoseconds(15);
  measure(nanoseconds(60));
  EXPECT_TRUE(before.agrees_with(wall));
  EXPECT_TRUE(wall.agrees_with(before));
  ahead += nanoseconds(100);
  wall = {};
  measure(nanoseconds(60));
  EXPECT_FALSE(before.agrees_with(wall));
}

}  // namespace
}  // namespace coupler::host
