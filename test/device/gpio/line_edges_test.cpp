// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/line_edges.hpp"

#include <gtest/gtest.h>

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

TEST(EdgeTally, On_a_line_watched_for_one_kind_they_are_what_is_expected) {
  EdgeTally tally(Edge::rising, false);
  tally.edge(true);
  tally.edge(true);
  const Edges edges = tally.take();
  EXPECT_EQ(edges.rising, 2U);
  EXPECT_EQ(edges.lost, 0U);
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
  Debounce input_{milliseconds(5), false};
};

TEST_F(Debouncing, A_line_that_never_changed_has_its_first_level) {
  EXPECT_FALSE(input_.level(at(0)));
  EXPECT_TRUE(Debounce(milliseconds(5), true).level(at(0)));
}

TEST_F(Debouncing, An_edge_counts_when_the_level_has_been_stable_for_the_period) {
  input_.edge(true, at(0));
  EXPECT_FALSE(input_.level(at(0)));
  EXPECT_FALSE(input_.level(at(4)));
  EXPECT_TRUE(input_.level(at(5)));
}

TEST_F(Debouncing, A_pulse_shorter_than_the_period_is_not_seen) {
  input_.edge(true, at(0));
  input_.edge(false, at(4));
  EXPECT_FALSE(input_.level(at(4)));
  EXPECT_FALSE(input_.level(at(100)));
}

TEST_F(Debouncing, Bouncing_delays_the_new_level_until_the_last_edge_is_old_enough) {
  for (int i = 0; i < 10; ++i) input_.edge(i % 2 == 0, at(i));
  input_.edge(true, at(10));
  EXPECT_FALSE(input_.level(at(14)));
  EXPECT_TRUE(input_.level(at(15)));
}

TEST_F(Debouncing, A_level_that_was_stable_counts_even_if_nobody_asked_meanwhile) {
  input_.edge(true, at(0));
  input_.edge(false, at(20));
  EXPECT_TRUE(input_.level(at(21))) << "on from 5 ms until the edge at 20 ms has settled";
  EXPECT_FALSE(input_.level(at(25)));
}

TEST_F(Debouncing, Two_edges_to_the_same_level_hide_a_third_and_begin_the_period_anew) {
  input_.edge(true, at(0));
  input_.edge(true, at(4));
  EXPECT_FALSE(input_.level(at(8)));
  EXPECT_TRUE(input_.level(at(9)));
}

TEST_F(Debouncing, Only_levels_that_settle_are_counted_as_edges) {
  for (const int ms : {0, 1, 2}) input_.edge(ms % 2 == 0, at(ms));
  input_.edge(false, at(20));
  input_.edge(true, at(21));
  input_.edge(false, at(22));
  const Edges edges = input_.take_edges(at(40));
  EXPECT_EQ(edges.rising, 1U);
  EXPECT_EQ(edges.falling, 1U);
  EXPECT_FALSE(input_.take_edges(at(60)).any()) << "each is told once";
}

}  // namespace
}  // namespace coupler::device
