// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/writers.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time begin{seconds(1000)};

/// As the panel looks: each tenth of a second. Whether they were gone in one of these moments.
bool are_gone(Writers& writers, Time from, Time to) {
  bool gone = false;
  for (Time now = from; now <= to; now += milliseconds(100)) gone |= writers.are_gone(now);
  return gone;
}

TEST(Writers, Nobody_is_gone_before_anybody_has_written) {
  Writers writers;
  writers.alive("a", begin);
  writers.left("a");
  EXPECT_FALSE(writers.are_gone(begin));
  EXPECT_FALSE(writers.are_gone(begin + seconds(100)));
}

TEST(Writers, Who_is_silent_for_two_seconds_is_gone) {
  Writers writers;
  writers.wrote("a", begin);
  EXPECT_FALSE(are_gone(writers, begin, begin + seconds(2)));
  EXPECT_TRUE(writers.are_gone(begin + milliseconds(2001)));
}

TEST(Writers, Who_is_gone_is_told_once) {
  Writers writers;
  writers.wrote("a", begin);
  EXPECT_TRUE(writers.are_gone(begin + seconds(3)));
  EXPECT_FALSE(writers.are_gone(begin + seconds(4)));
  writers.alive("a", begin + seconds(4));  // a phone that wakes up
  EXPECT_FALSE(writers.are_gone(begin + seconds(10)));
  writers.wrote("a", begin + seconds(10));
  EXPECT_TRUE(are_gone(writers, begin + seconds(10), begin + seconds(13)));
}

TEST(Writers, A_pause_of_the_panel_itself_is_nobodys_silence) {
  Writers writers;
  writers.wrote("a", begin);
  EXPECT_FALSE(writers.are_gone(begin));
  EXPECT_FALSE(writers.are_gone(begin + seconds(10)));  // half a second of it counts
  EXPECT_FALSE(are_gone(writers, begin + seconds(10), begin + milliseconds(11500)));
  EXPECT_TRUE(writers.are_gone(begin + milliseconds(11600)));
}

TEST(Writers, Who_was_heard_in_a_pause_of_the_panel_has_no_longer_than_others) {
  Writers writers;
  EXPECT_FALSE(writers.are_gone(begin));
  writers.wrote("a", begin + seconds(9));
  EXPECT_FALSE(are_gone(writers, begin + seconds(10), begin + seconds(12)));
  EXPECT_TRUE(writers.are_gone(begin + milliseconds(12100)));
}

TEST(Writers, Who_says_that_he_is_there_is_not_gone) {
  Writers writers;
  writers.wrote("a", begin);
  for (int second = 1; second < 10; ++second) {
    writers.alive("a", begin + seconds(second));
    EXPECT_FALSE(are_gone(writers, begin + seconds(second), begin + seconds(second + 1)));
  }
}

TEST(Writers, Who_writes_again_is_not_gone) {
  Writers writers;
  writers.wrote("a", begin);
  writers.wrote("a", begin + seconds(2));
  EXPECT_FALSE(writers.are_gone(begin + seconds(4)));
}

TEST(Writers, Who_leaves_is_gone_at_once) {
  Writers writers;
  writers.wrote("a", begin);
  writers.left("a");
  EXPECT_TRUE(writers.are_gone(begin));
}

TEST(Writers, As_long_as_one_is_there_they_are_not_gone) {
  Writers writers;
  writers.wrote("a", begin);
  writers.wrote("b", begin + seconds(1));
  writers.left("a");
  EXPECT_FALSE(are_gone(writers, begin + seconds(1), begin + seconds(3)));
  EXPECT_TRUE(are_gone(writers, begin + seconds(3), begin + seconds(4)));
}

TEST(Writers, Who_only_looks_counts_for_nothing) {
  Writers writers;
  writers.wrote("a", begin);
  for (int second = 0; second < 3; ++second) writers.alive("looks", begin + seconds(second));
  writers.left("looks");
  EXPECT_TRUE(writers.are_gone(begin + seconds(3)));
}

}  // namespace
}  // namespace coupler::host
