// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/device/gpio/edge_tally.hpp"

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

}  // namespace
}  // namespace coupler::device
