// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/strategy.hpp"

#include <gtest/gtest.h>

#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using fakes::MapBuilder;

TEST(Strategy, Holes_cost_requests_unless_they_are_read) {
  auto builder = MapBuilder().many(hr, 0, 1).many(hr, 3, 1).many(hr, 50, 1);
  builder.head().polling.register_continuous = true;
  const auto [never, map, pays] = compare_strategies(builder.build()->map(), {});
  EXPECT_EQ(never.cost.requests, 3U);
  EXPECT_EQ(map.cost.requests, 2U);
  EXPECT_EQ(pays.cost.requests, 1U);
  EXPECT_GT(never.load, map.load);
  EXPECT_GT(map.load, pays.load);
}

TEST(Strategy, The_proposed_gap_is_the_smallest_that_does_it) {
  const auto owned = MapBuilder().many(hr, 0, 1).many(hr, 3, 1).many(hr, 50, 1).many(hr, 500, 1).build();
  const Strategy pays = compare_strategies(owned->map(), {})[2];
  EXPECT_TRUE(pays.polling.register_continuous);
  EXPECT_EQ(pays.polling.register_gap, 47);
  Map map = owned->map();
  map.polling = pays.polling;
  EXPECT_EQ(make_read_plan(map).front().spans.size(), pays.cost.requests);
  map.polling.register_gap = 46;
  EXPECT_EQ(make_read_plan(map).front().spans.size(), pays.cost.requests + 1);
}

TEST(Strategy, Without_holes_to_read_nothing_is_proposed) {
  const auto owned = MapBuilder().many(hr, 0, 10).many(hr, 500, 1).build();
  const Strategy pays = compare_strategies(owned->map(), {})[2];
  EXPECT_FALSE(pays.polling.register_continuous);
  EXPECT_FALSE(pays.polling.discrete_continuous);
  EXPECT_EQ(pays.polling.register_gap, owned->map().polling.register_gap);
}

TEST(Strategy, A_hole_that_takes_longer_than_a_request_does_not_pay) {
  const auto owned = MapBuilder().many(hr, 0, 1).many(hr, 20, 1).build();
  const Link quick{std::chrono::microseconds(1)};  // 6 registers take as long
  EXPECT_EQ(compare_strategies(owned->map(), quick)[2].cost.requests, 2U);
  EXPECT_EQ(compare_strategies(owned->map(), {})[2].cost.requests, 1U);
}

}  // namespace
}  // namespace coupler::plan
