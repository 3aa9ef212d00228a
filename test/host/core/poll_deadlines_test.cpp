// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/poll_deadlines.hpp"

#include <gtest/gtest.h>

#include "coupler/host/core/backoff.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

constexpr Time start = Time{} + std::chrono::hours(1);

struct PollDeadlinesTest : testing::Test {
  PollDeadlinesTest() { deadlines.start(start); }
  milliseconds due() const { return std::chrono::duration_cast<milliseconds>(deadlines.due() - start); }
  PollDeadlines deadlines{milliseconds(100)};
};

TEST_F(PollDeadlinesTest, The_first_deadline_is_the_start) { EXPECT_EQ(due(), milliseconds(0)); }

TEST_F(PollDeadlinesTest, Deadlines_are_counted_from_the_start_not_from_the_end_of_a_cycle) {
  deadlines.advance(start + milliseconds(30));
  EXPECT_EQ(due(), milliseconds(100));
  deadlines.advance(start + milliseconds(190));
  EXPECT_EQ(due(), milliseconds(200));
  EXPECT_EQ(deadlines.overruns(), 0U);
}

TEST_F(PollDeadlinesTest, Deadlines_that_passed_are_counted_and_left_out) {
  deadlines.advance(start + milliseconds(350));
  EXPECT_EQ(due(), milliseconds(400));
  EXPECT_EQ(deadlines.overruns(), 3U);
}

TEST_F(PollDeadlinesTest, A_cycle_that_ends_on_the_next_deadline_has_missed_it) {
  deadlines.advance(start + milliseconds(100));
  EXPECT_EQ(due(), milliseconds(200));
  EXPECT_EQ(deadlines.overruns(), 1U);
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
