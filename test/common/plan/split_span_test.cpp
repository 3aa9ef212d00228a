// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/plan/planner.hpp"
#include "coupler/plan/split_span.hpp"
#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using fakes::MapBuilder;
using modbus::Range;

struct SplitTest : testing::Test {
  /// The parts of the one request that the map needs.
  Split parts(MapBuilder builder) {
    builder.head().polling.register_continuous = true;
    owned = builder.build();
    const auto plan = make_read_plan(owned->map());
    EXPECT_EQ(plan.size(), 1U);
    EXPECT_EQ(plan.front().spans.size(), 1U);
    return split(plan.front().spans.front(), owned->map());
  }
  MapPtr owned;
};

TEST_F(SplitTest, Parts_are_separated_where_unmapped_addresses_are) {
  const Split split = parts(MapBuilder().many(hr, 0, 3).many(hr, 5, 1));
  ASSERT_EQ(split.pieces.size(), 2U);
  EXPECT_EQ(split.pieces[0].range, Range::of(0, 3));
  EXPECT_EQ(split.pieces[1].range, Range::of(5, 1));
  EXPECT_EQ(split.hole, Range::of(3, 2));
}

TEST_F(SplitTest, Of_many_holes_the_one_in_the_middle_parts) {
  const Split split = parts(MapBuilder().many(hr, 0, 1).many(hr, 2, 1).many(hr, 4, 1).many(hr, 6, 1));
  EXPECT_EQ(split.hole, Range::of(3, 1));
}

TEST_F(SplitTest, Without_unmapped_addresses_the_points_are_halved) {
  const Split split = parts(MapBuilder().add(hr, "a", 0, codec::Type::LREAL).many(hr, 4, 3));
  ASSERT_EQ(split.pieces.size(), 2U);
  EXPECT_EQ(split.pieces[0].range, Range::of(0, 5));
  EXPECT_EQ(split.pieces[1].range, Range::of(5, 2));
  EXPECT_EQ(split.hole, std::nullopt);
}

TEST_F(SplitTest, A_point_under_others_makes_no_hole) {
  const Split split =
      parts(MapBuilder().add(hr, "wide", 0, codec::Type::LREAL).many(hr, 1, 1).many(hr, 4, 1));
  EXPECT_EQ(split.hole, std::nullopt);
}

TEST_F(SplitTest, Points_that_share_a_register_stay_together) {
  MapBuilder builder;
  for (std::uint8_t bit = 0; bit < 6; ++bit)
    builder.add(hr, "bit_" + std::to_string(bit), 0, codec::Type::BOOL,
                [bit](Point& point) { point.format.bit = bit; });
  const Split split = parts(builder.many(hr, 1, 2));
  ASSERT_EQ(split.pieces.size(), 2U);
  EXPECT_EQ(split.pieces[0].range, Range::of(0, 1));
  EXPECT_EQ(split.pieces[0].points.size(), 6U);
  EXPECT_EQ(split.pieces[1].range, Range::of(1, 2));
}

TEST_F(SplitTest, Of_points_that_all_overlap_half_go_to_each_part) {
  const Split split = parts(MapBuilder()
                                .add(hr, "a", 0, codec::Type::DWORD)
                                .add(hr, "b", 1, codec::Type::DWORD)
                                .add(hr, "c", 2, codec::Type::DWORD)
                                .add(hr, "d", 3, codec::Type::DWORD));
  ASSERT_EQ(split.pieces.size(), 2U);
  EXPECT_EQ(split.pieces[0].range, Range::of(0, 3));
  EXPECT_EQ(split.pieces[1].range, Range::of(2, 3));
}

TEST_F(SplitTest, A_lone_point_has_no_parts) {
  EXPECT_TRUE(parts(MapBuilder().many(hr, 0, 1)).pieces.empty());
}

}  // namespace
}  // namespace coupler::plan
