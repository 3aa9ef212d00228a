// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/schedule.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

constexpr Time start = Time{} + std::chrono::hours(1);

struct ScheduleTest : testing::Test {
  ScheduleTest() { schedule.start(start); }
  milliseconds due() const { return std::chrono::duration_cast<milliseconds>(schedule.due() - start); }
  Schedule schedule{milliseconds(100)};
};

TEST_F(ScheduleTest, The_first_deadline_is_the_start) { EXPECT_EQ(due(), milliseconds(0)); }

TEST_F(ScheduleTest, Deadlines_are_counted_from_the_start_not_from_the_end_of_a_cycle) {
  schedule.advance(start + milliseconds(30));
  EXPECT_EQ(due(), milliseconds(100));
  schedule.advance(start + milliseconds(190));
  EXPECT_EQ(due(), milliseconds(200));
  EXPECT_EQ(schedule.overruns(), 0U);
}

TEST_F(ScheduleTest, Deadlines_that_passed_are_counted_and_left_out) {
  schedule.advance(start + milliseconds(350));
  EXPECT_EQ(due(), milliseconds(400));
  EXPECT_EQ(schedule.overruns(), 3U);
}

TEST_F(ScheduleTest, A_cycle_that_ends_on_the_next_deadline_has_missed_it) {
  schedule.advance(start + milliseconds(100));
  EXPECT_EQ(due(), milliseconds(200));
  EXPECT_EQ(schedule.overruns(), 1U);
}

TEST(Backoff, The_wait_doubles_from_a_tenth_of_a_second_up_to_5_seconds) {
  Backoff backoff;
  for (const int expected : {100, 200, 400, 800, 1600, 3200, 5000, 5000})
    EXPECT_EQ(backoff.next(), milliseconds(expected));
}

TEST(Backoff, After_a_success_it_begins_anew) {
  Backoff backoff;
  backoff.next();
  backoff.next();
  backoff.reset();
  EXPECT_EQ(backoff.next(), milliseconds(100));
}

}  // namespace
}  // namespace coupler::host
