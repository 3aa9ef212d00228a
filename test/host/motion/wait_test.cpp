// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/wait.hpp"

#include <gtest/gtest.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

/// The goal counts from 1000 ms on.
struct WaitTest : testing::Test {
  static Time at(int ms) { return Time(milliseconds(ms)); }
  Wait wait(std::string_view relation, std::string_view value, int for_at_least = 0) const {
    const Point& point = map->map().points[0];
    return Wait(
        {0, *Condition::parse(point, relation, value), milliseconds(for_at_least), at(1000), at(9000)},
        point);
  }
  static void see(Wait& wait, int ms, std::uint16_t value, int uncertainty = 1) {
    wait.see({at(ms), milliseconds(uncertainty)}, &value);
  }

  MapPtr map = fakes::MapBuilder().holding("x", 0).build();
};

TEST_F(WaitTest, A_value_that_was_read_before_the_goal_meets_nothing) {
  Wait equal = wait("==", "5");
  see(equal, 900, 5);
  see(equal, 1000, 5, 2);  // perhaps at 998 ms
  EXPECT_FALSE(equal.is_met() || equal.has_seen());
  see(equal, 1100, 5);
  EXPECT_TRUE(equal.is_met());
  EXPECT_EQ(equal.since()->at, at(1100));
}

TEST_F(WaitTest, A_change_that_may_have_been_after_the_goal_counts) {
  Wait rises = wait("rises", "5");
  const std::uint16_t before = 4;
  rises.begin_with(&before);
  see(rises, 999, 6, 3);  // perhaps at 1002 ms
  EXPECT_TRUE(rises.is_met());
}

TEST_F(WaitTest, A_change_before_the_goal_is_none) {
  Wait rises = wait("rises", "5");
  see(rises, 800, 4);
  see(rises, 900, 6);
  see(rises, 1100, 7);
  EXPECT_FALSE(rises.is_met());
  see(rises, 1200, 4);
  see(rises, 1300, 5);
  EXPECT_TRUE(rises.is_met());
}

TEST_F(WaitTest, The_first_value_is_no_change) {
  Wait changes = wait("changes", "");
  see(changes, 1100, 4);
  EXPECT_FALSE(changes.is_met());
  see(changes, 1200, 4);
  EXPECT_FALSE(changes.is_met());
  see(changes, 1300, 5);
  EXPECT_TRUE(changes.is_met());
}

TEST_F(WaitTest, A_condition_must_hold_for_as_long_as_was_asked_for) {
  Wait greater = wait(">", "5", 300);
  see(greater, 1100, 6);
  EXPECT_EQ(greater.due(), at(1400));
  see(greater, 1300, 5);  // it begins anew
  EXPECT_EQ(greater.due(), Time::max());
  see(greater, 1400, 7);
  see(greater, 1699, 8);
  EXPECT_FALSE(greater.is_met());
  see(greater, 1700, 8);
  EXPECT_TRUE(greater.is_met());
  EXPECT_EQ(greater.since()->at, at(1400));
}

TEST_F(WaitTest, An_event_must_not_be_undone_for_as_long_as_was_asked_for) {
  Wait rises = wait("rises", "5", 300);
  see(rises, 1100, 0);
  see(rises, 1200, 5);
  see(rises, 1300, 0);  // it bounces
  see(rises, 1350, 5);
  see(rises, 1600, 6);
  EXPECT_FALSE(rises.is_met());
  see(rises, 1650, 6);
  EXPECT_TRUE(rises.is_met());
}

TEST_F(WaitTest, A_value_that_goes_on_changing_has_not_settled) {
  Wait settles = wait("changes", "", 300);
  see(settles, 1100, 0);
  see(settles, 1200, 1);
  see(settles, 1400, 2);
  see(settles, 1600, 2);
  EXPECT_FALSE(settles.is_met());
  see(settles, 1700, 2);
  EXPECT_TRUE(settles.is_met());
}

TEST_F(WaitTest, After_an_interruption_what_holds_begins_anew) {
  Wait equal = wait("==", "5", 300);
  see(equal, 1100, 5);
  equal.interrupt();
  see(equal, 1400, 5);
  EXPECT_FALSE(equal.is_met());
  see(equal, 1700, 5);
  EXPECT_TRUE(equal.is_met());
}

}  // namespace
}  // namespace coupler::host
