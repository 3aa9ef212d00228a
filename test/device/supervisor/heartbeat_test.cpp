// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/heartbeat.hpp"

#include <gtest/gtest.h>

namespace coupler::device {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr milliseconds turn{100};

/// Looks at another process; the clock is here.
class Watched : public testing::Test {
 protected:
  void look(nanoseconds elapsed, nanoseconds waits = nanoseconds(0), bool heard = false) {
    now_ += elapsed;
    waited_ += waits;
    silence_.sample(now_, heard, waited_);
  }
  /// Full turns until it was silent for too long; how many there were.
  int turns_until_too_long(nanoseconds waits) {
    for (int count = 1; count < 1000; ++count) {
      look(turn, waits);
      if (silence_.is_too_long()) return count;
    }
    return -1;
  }

  TimePoint now_{seconds(1000)};
  nanoseconds waited_{seconds(7)};  ///< in its life before
  Silence silence_{now_, turn, waited_};
};

TEST_F(Watched, A_silence_of_a_second_is_too_long) { EXPECT_EQ(turns_until_too_long(milliseconds(0)), 10); }

TEST_F(Watched, Whatever_is_heard_ends_a_silence) {
  for (int i = 0; i < 100; ++i) {
    look(turn, milliseconds(0), i % 9 == 8);
    EXPECT_FALSE(silence_.is_too_long()) << i;
  }
}

TEST_F(Watched, The_time_without_a_CPU_is_deducted) {
  EXPECT_EQ(turns_until_too_long(milliseconds(50)), 20);
  EXPECT_EQ(silence_.lasted(), seconds(2));
  EXPECT_EQ(silence_.starved(), seconds(1));
}

TEST_F(Watched, Five_seconds_are_too_long_in_any_case) {
  EXPECT_EQ(turns_until_too_long(turn), 50);
  EXPECT_EQ(silence_.starved(), seconds(5));
}

TEST_F(Watched, What_it_waited_before_it_fell_silent_is_not_deducted) {
  look(turn, milliseconds(90), true);
  EXPECT_EQ(turns_until_too_long(milliseconds(0)), 10);
}

TEST_F(Watched, A_wait_that_is_counted_late_is_deducted_all_the_same) {
  look(turn);
  look(turn, milliseconds(190));
  EXPECT_EQ(silence_.starved(), milliseconds(190));
}

TEST_F(Watched, A_wait_that_was_none_is_deducted_no_longer) {
  look(turn, milliseconds(100));
  look(turn, milliseconds(-100));
  EXPECT_EQ(silence_.lasted(), milliseconds(200));
  EXPECT_EQ(silence_.starved(), milliseconds(0));
}

TEST_F(Watched, No_more_than_the_silence_is_deducted) {
  look(milliseconds(10), seconds(3));
  EXPECT_EQ(turns_until_too_long(milliseconds(0)), 10);
}

TEST_F(Watched, A_turn_counts_for_no_longer_than_it_may_last) {
  look(seconds(30));
  EXPECT_EQ(silence_.lasted(), turn) << "this process was stopped itself";
  EXPECT_FALSE(silence_.is_too_long());
}

TEST_F(Watched, Of_a_turn_that_lasted_too_long_no_more_is_deducted_than_counts) {
  look(turn);
  look(seconds(30), seconds(30));
  EXPECT_EQ(silence_.lasted(), 2 * turn);
  EXPECT_EQ(silence_.starved(), turn);
}

TEST_F(Watched, A_turn_counts_for_no_longer_than_it_took) {
  for (int i = 0; i < 999; ++i) look(milliseconds(1));
  EXPECT_FALSE(silence_.is_too_long());
  look(milliseconds(1));
  EXPECT_TRUE(silence_.is_too_long());
}

}  // namespace
}  // namespace coupler::device
