// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/change_history.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <tuple>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

struct ChangeHistoryTest : testing::Test {
  using Seen = std::tuple<int, std::optional<unsigned>, unsigned>;  ///< ms, before, now

  static Time at(int ms) { return Time(milliseconds(ms)); }
  void see(std::uint32_t point, int ms, std::uint16_t value, bool is_told = false) {
    history.see(point, {at(ms), milliseconds(1)}, &value, is_told);
  }
  std::vector<Seen> since(std::uint32_t point, int ms) const {
    std::vector<Seen> seen;
    history.each_since(point, at(ms), [&](const ChangeHistory::Change& change) {
      seen.emplace_back(static_cast<int>(change.stamp.at.time_since_epoch() / milliseconds(1)),
                        change.has_before ? std::optional<unsigned>(change.before[0]) : std::nullopt,
                        change.now[0]);
    });
    return seen;
  }
  Time before_until() const {
    Time until{};
    history.each_since(0, at(0),
                       [&](const ChangeHistory::Change& change) { until = change.before_until.at; });
    return until;
  }

  MapPtr map = fakes::MapBuilder()
                   .holding("a", 0)
                   .holding("b", 1)
                   .add(Table::holding_registers, "long", 2, codec::Type::UINT, [](Point& p) { p.count = 6; })
                   .build();
  ChangeHistory history{map->map(), at(50)};
};

TEST_F(ChangeHistoryTest, It_has_the_changes_of_a_point_that_may_have_been_since_a_time) {
  see(0, 100, 1);
  see(1, 150, 7);
  see(0, 200, 2);
  see(0, 300, 3);
  EXPECT_EQ(since(0, 201), (std::vector<Seen>{{200, 1U, 2U}, {300, 2U, 3U}}));
  EXPECT_EQ(since(0, 0), (std::vector<Seen>{{100, std::nullopt, 1U}, {200, 1U, 2U}, {300, 2U, 3U}}));
  EXPECT_EQ(since(1, 0), (std::vector<Seen>{{150, std::nullopt, 7U}}));
}

TEST_F(ChangeHistoryTest, It_says_how_far_back_it_reaches) {
  EXPECT_FALSE(history.reaches(at(50)));
  EXPECT_TRUE(history.reaches(at(51)));
  for (int i = 0; i < static_cast<int>(ChangeHistory::most_changes) + 10; ++i)
    see(0, 1000 + i, static_cast<std::uint16_t>(i));
  EXPECT_FALSE(history.reaches(at(1010)));  // the change at 1009 ms may have been then
  EXPECT_TRUE(history.reaches(at(1011)));
  EXPECT_EQ(since(0, 1011).size(), ChangeHistory::most_changes);
  EXPECT_EQ(since(0, 1011).front(), Seen(1010, 9U, 10U));
}

TEST_F(ChangeHistoryTest, A_polled_value_was_known_until_the_reading_before_the_change) {
  see(0, 100, 1);
  see(0, 200, 1);
  see(0, 300, 2);
  EXPECT_EQ(before_until(), at(200));
}

TEST_F(ChangeHistoryTest, An_announced_change_ends_the_value_before) {
  see(0, 100, 1);
  see(0, 300, 2, true);
  EXPECT_EQ(before_until(), at(300));
}

TEST_F(ChangeHistoryTest, After_an_interruption_nothing_is_known_of_the_value_before) {
  see(0, 100, 1);
  history.lose(0);
  EXPECT_EQ(history.last(0), nullptr);
  see(0, 200, 1);
  see(0, 300, 2);
  history.lose_all();
  see(0, 400, 3);
  EXPECT_EQ(since(0, 150),
            (std::vector<Seen>{{200, std::nullopt, 1U}, {300, 1U, 2U}, {400, std::nullopt, 3U}}));
}

TEST_F(ChangeHistoryTest, It_keeps_no_long_values) {
  EXPECT_TRUE(history.keeps(0));
  EXPECT_FALSE(history.keeps(2));
}

}  // namespace
}  // namespace coupler::host
