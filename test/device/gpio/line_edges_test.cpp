// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/line_edges.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace coupler::device {
namespace {

TEST(EdgeTally, Edges_are_counted_by_kind_and_told_once) {
  EdgeTally tally(Edge::both, false);
  for (const bool rising : {true, false, true}) tally.edge(rising);
  const Edges edges = tally.take();
  EXPECT_EQ(edges.rising, 2U);
  EXPECT_EQ(edges.falling, 1U);
  EXPECT_EQ(edges.lost, 0U);
  EXPECT_FALSE(tally.take().any());
}

TEST(EdgeTally, Equal_edges_in_a_row_on_a_line_watched_for_both_hide_one) {
  EdgeTally tally(Edge::both, true);
  tally.edge(true);
  tally.edge(true);
  EXPECT_EQ(tally.take().lost, 2U) << "the first one follows a level that was on already";
}

TEST(EdgeTally, Where_one_kind_is_counted_only_its_losses_are) {
  EdgeTally tally(Edge::rising, false);
  EXPECT_FALSE(tally.edge(true));
  EXPECT_TRUE(tally.edge(true)) << "a falling one is missing";
  EXPECT_EQ(tally.take().lost, 0U);
  tally.edge(false);
  EXPECT_TRUE(tally.edge(false));
  const Edges edges = tally.take();
  EXPECT_EQ(edges.lost, 1U);
  EXPECT_EQ(edges.falling, 2U);
}

TEST(EdgeTally, Of_edges_that_the_kernel_dropped_half_are_of_one_kind) {
  EdgeTally tally(Edge::falling, false);
  tally.lose(10);
  EXPECT_EQ(tally.take().lost, 5U);
  tally.lose(1);
  EXPECT_EQ(tally.take().lost, 1U) << "it may have been this one";
}

TEST(EdgeTally, A_known_loss_is_not_counted_again_when_the_next_edge_shows_it) {
  EdgeTally tally(Edge::both, false);
  tally.edge(true);
  tally.lose(3);
  tally.edge(true);
  EXPECT_EQ(tally.take().lost, 3U);
}

using std::chrono::milliseconds;

class Debouncing : public testing::Test {
 protected:
  static TimePoint at(int ms) { return TimePoint(std::chrono::hours(1)) + milliseconds(ms); }
  bool level(TimePoint now) {
    if (const auto settled = input_.settle(now)) settled_.push_back(*settled);
    return input_.level();
  }
  void edge(bool level, TimePoint when) {
    if (const auto settled = input_.edge(level, when)) settled_.push_back(*settled);
  }
  Debounce input_{milliseconds(5), false};
  std::vector<LevelSince> settled_;  ///< what was told
};

TEST_F(Debouncing, A_line_that_never_changed_has_its_first_level) {
  EXPECT_FALSE(level(at(0)));
  EXPECT_TRUE(Debounce(milliseconds(5), true).level());
}

TEST_F(Debouncing, An_edge_counts_when_the_level_has_been_stable_for_the_period) {
  edge(true, at(0));
  EXPECT_FALSE(level(at(0)));
  EXPECT_FALSE(level(at(4)));
  EXPECT_TRUE(level(at(5)));
}

TEST_F(Debouncing, A_pulse_shorter_than_the_period_is_not_seen) {
  edge(true, at(0));
  edge(false, at(4));
  EXPECT_FALSE(level(at(4)));
  EXPECT_FALSE(level(at(100)));
}

TEST_F(Debouncing, Bouncing_delays_the_new_level_until_the_last_edge_is_old_enough) {
  for (int i = 0; i < 10; ++i) edge(i % 2 == 0, at(i));
  edge(true, at(10));
  EXPECT_FALSE(level(at(14)));
  EXPECT_TRUE(level(at(15)));
}

TEST_F(Debouncing, A_level_that_was_stable_counts_even_if_nobody_asked_meanwhile) {
  edge(true, at(0));
  edge(false, at(20));
  EXPECT_TRUE(level(at(21))) << "on from 5 ms until the edge at 20 ms has settled";
  EXPECT_FALSE(level(at(25)));
}

TEST_F(Debouncing, Two_edges_to_the_same_level_hide_a_third_and_begin_the_period_anew) {
  edge(true, at(0));
  edge(true, at(4));
  EXPECT_FALSE(level(at(8)));
  EXPECT_TRUE(level(at(9)));
}

TEST_F(Debouncing, Only_levels_that_settle_are_told_each_since_the_edge_that_brought_it) {
  for (const int ms : {0, 1, 2}) edge(ms % 2 == 0, at(ms));
  edge(false, at(20));
  edge(true, at(21));
  edge(false, at(22));
  EXPECT_FALSE(level(at(40)));
  ASSERT_EQ(settled_.size(), 2U);
  EXPECT_TRUE(settled_[0].level);
  EXPECT_EQ(settled_[0].at, at(2));
  EXPECT_FALSE(settled_[1].level);
  EXPECT_EQ(settled_[1].at, at(22));
  EXPECT_FALSE(level(at(60)));
  EXPECT_EQ(settled_.size(), 2U) << "each is told once";
}

TEST_F(Debouncing, The_end_of_the_period_is_known_in_advance) {
  EXPECT_EQ(input_.due(), std::nullopt);
  edge(true, at(3));
  EXPECT_EQ(input_.due(), at(8));
  edge(false, at(4));
  EXPECT_EQ(input_.due(), std::nullopt) << "it is back at the level that counts";
  edge(true, at(5));
  EXPECT_TRUE(level(at(10)));
  EXPECT_EQ(input_.due(), std::nullopt);
}

}  // namespace
}  // namespace coupler::device
