// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/intervals.hpp"

#include <gtest/gtest.h>

namespace coupler::plan {
namespace {

using modbus::Range;

const Intervals set({Range::of(10, 5), Range::of(15, 5), Range::of(12, 1), Range::of(30, 1)});

TEST(Intervals, What_touches_or_overlaps_is_one) { EXPECT_TRUE(set.covers(Range::of(10, 10))); }

TEST(Intervals, A_range_is_covered_only_as_a_whole) {
  EXPECT_FALSE(set.covers(Range::of(9, 2)));
  EXPECT_FALSE(set.covers(Range::of(19, 2)));
  EXPECT_FALSE(set.covers(Range::of(18, 13)));
  EXPECT_TRUE(set.covers(Range::of(30, 1)));
}

TEST(Intervals, One_common_address_is_an_overlap) {
  EXPECT_TRUE(set.overlaps(Range::of(0, 11)));
  EXPECT_TRUE(set.overlaps(Range::of(19, 5)));
  EXPECT_FALSE(set.overlaps(Range::of(20, 10)));
  EXPECT_FALSE(set.overlaps(Range::of(31, 100)));
}

TEST(Intervals, The_empty_set_has_nothing) {
  EXPECT_FALSE(Intervals().covers(Range::of(0, 1)));
  EXPECT_FALSE(Intervals().overlaps(Range::of(0, 65536)));
}

}  // namespace
}  // namespace coupler::plan
