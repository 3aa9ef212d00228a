// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using Range = std::optional<std::pair<float, float>>;

constexpr std::size_t last_step = History::steps - 1;

/// Steps begin at even seconds of the clock; this is one of them.
constexpr Time start{seconds(100'000)};

class HistoryTest : public testing::Test {
 protected:
  /// `back` steps before the newest.
  Range back(std::size_t back) const {
    const History::Step& step = history_->at(last_step - back);
    if (std::isnan(step.least) && std::isnan(step.greatest)) return std::nullopt;
    return std::pair(step.least, step.greatest);
  }
  std::size_t known() const {
    std::size_t known = 0;
    for (std::size_t i = 0; i < History::steps; ++i) known += back(i) ? 1 : 0;
    return known;
  }
  static Range range(float least, float greatest) { return std::pair(least, greatest); }

  std::unique_ptr<History> history_ = std::make_unique<History>();
};

TEST_F(HistoryTest, Lasts_ten_minutes) {
  EXPECT_EQ(History::steps, 300U);
  EXPECT_EQ(History::step, seconds(2));
}

TEST_F(HistoryTest, Nothing_is_known_before_the_first_value) {
  EXPECT_EQ(known(), 0U);
  history_->advance(start);
  EXPECT_EQ(known(), 0U);
  history_->take(7, start + seconds(10));
  EXPECT_EQ(back(0), range(7, 7));
  EXPECT_EQ(known(), 1U);
}

TEST_F(HistoryTest, A_step_has_the_least_and_the_greatest_of_its_values) {
  for (const double value : {5.0, -3.0, 9.0, 0.0}) history_->take(value, start + milliseconds(500));
  EXPECT_EQ(back(0), range(-3, 9));
  EXPECT_EQ(known(), 1U);
}

TEST_F(HistoryTest, A_pulse_between_two_steps_is_in_one_of_them) {
  history_->take(0, start);
  history_->take(1, start + milliseconds(2900));
  history_->take(0, start + milliseconds(2901));
  history_->advance(start + seconds(4));
  EXPECT_EQ(back(2), range(0, 0));
  EXPECT_EQ(back(1), range(0, 1));
  EXPECT_EQ(back(0), range(0, 0));
}

TEST_F(HistoryTest, A_value_holds_until_there_is_another_one) {
  history_->take(4, start);
  history_->take(6, start + seconds(10));  // five steps later
  history_->advance(start + seconds(14));
  EXPECT_EQ(known(), 8U);
  for (std::size_t i = 3; i < 8; ++i) EXPECT_EQ(back(i), range(4, 4)) << i;
  EXPECT_TRUE(back(2) == range(4, 6) || back(2) == range(6, 6)) << "6 came as the step began";
  EXPECT_EQ(back(1), range(6, 6));
  EXPECT_EQ(back(0), range(6, 6));
}

TEST_F(HistoryTest, What_comes_within_a_step_is_beside_what_held_before) {
  history_->take(4, start);
  history_->take(6, start + milliseconds(2500));
  EXPECT_EQ(back(1), range(4, 4));
  EXPECT_EQ(back(0), range(4, 6));
}

TEST_F(HistoryTest, A_step_ends_where_the_next_one_begins) {
  history_->take(1, start);
  history_->take(2, start + seconds(2) - nanoseconds(1));
  EXPECT_EQ(back(0), range(1, 2));
  EXPECT_EQ(known(), 1U);
  history_->take(3, start + seconds(2));
  EXPECT_EQ(back(1), range(1, 2));
  EXPECT_EQ(back(0)->second, 3);
  EXPECT_EQ(known(), 2U);
}

TEST_F(HistoryTest, A_lost_value_holds_no_longer) {
  history_->take(4, start);
  history_->lose(start + seconds(3));
  history_->advance(start + seconds(9));
  EXPECT_EQ(back(4), range(4, 4));
  EXPECT_EQ(back(3), range(4, 4)) << "it was known for a second of that step";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(back(i), Range()) << i;
  history_->take(5, start + seconds(9));
  EXPECT_EQ(back(0), range(5, 5)) << "nothing is known of the time before";
  history_->advance(start + seconds(11));
  EXPECT_EQ(back(0), range(5, 5));
}

TEST_F(HistoryTest, Losing_what_was_never_known_is_nothing) {
  history_->lose(start);
  history_->lose(start + seconds(100));
  EXPECT_EQ(known(), 0U);
}

TEST_F(HistoryTest, The_oldest_of_300_steps_goes_when_a_new_one_begins) {
  history_->take(1, start);
  history_->take(2, start + milliseconds(1));
  history_->advance(start + 299 * History::step);
  EXPECT_EQ(back(last_step), range(1, 2));
  EXPECT_EQ(known(), 300U);
  history_->advance(start + 300 * History::step);
  EXPECT_EQ(back(last_step), range(2, 2));
  EXPECT_EQ(known(), 300U);
}

TEST_F(HistoryTest, Each_step_keeps_its_place_as_they_go_round) {
  for (int i = 0; i < 1000; ++i) history_->take(i, start + i * History::step + seconds(1));
  for (std::size_t i = 0; i < History::steps; ++i) {
    const auto value = static_cast<float>(999 - i);
    EXPECT_EQ(back(i), range(value - 1, value)) << i;
  }
}

TEST_F(HistoryTest, After_a_gap_longer_than_all_steps_only_what_held_is_left) {
  for (const int steps : {300, 301, 302, 599, 600, 601, 100'000}) {
    history_ = std::make_unique<History>();
    history_->take(1, start);
    history_->take(8, start + seconds(1));
    const Time late = start + steps * History::step;
    history_->advance(late);
    EXPECT_EQ(known(), 300U) << steps;
    for (std::size_t i = 0; i < History::steps; ++i) EXPECT_EQ(back(i), range(8, 8)) << steps << ' ' << i;
    history_->take(9, late + seconds(3));
    EXPECT_EQ(back(0), range(8, 9)) << steps;
    EXPECT_EQ(back(1), range(8, 8)) << steps;
  }
}

TEST_F(HistoryTest, After_a_gap_longer_than_all_steps_nothing_is_left_of_what_was_lost) {
  for (const int steps : {300, 301, 302, 1000, 100'000}) {
    history_ = std::make_unique<History>();
    history_->take(1, start);
    history_->lose(start + seconds(1));
    history_->advance(start + steps * History::step);
    EXPECT_EQ(known(), 0U) << steps;
    history_->take(2, start + steps * History::step);
    EXPECT_EQ(back(0), range(2, 2)) << steps;
    EXPECT_EQ(known(), 1U) << steps;
  }
}

TEST_F(HistoryTest, A_machine_may_have_been_started_a_moment_ago) {
  history_->take(3, Time{} + milliseconds(500));
  history_->advance(Time{} + seconds(5));
  EXPECT_EQ(back(0), range(3, 3));
  EXPECT_EQ(back(1), range(3, 3));
  EXPECT_EQ(back(2), range(3, 3));
  EXPECT_EQ(known(), 3U);
}

TEST_F(HistoryTest, A_time_a_little_earlier_than_the_last_one_is_in_the_newest_step) {
  history_->take(1, start + seconds(4));
  history_->take(2, start + seconds(3));  // a value's stamp, after a page has asked
  EXPECT_EQ(back(0), range(1, 2));
  EXPECT_EQ(known(), 1U);
}

TEST_F(HistoryTest, A_value_that_is_no_number_takes_nothing_from_the_others_of_its_step) {
  history_->take(1, start);
  history_->take(5, start);
  history_->take(std::nan(""), start + milliseconds(1));
  EXPECT_EQ(back(0), range(1, 5));
  history_->advance(start + seconds(2));
  EXPECT_EQ(back(0), Range()) << "it is what holds";
  history_->take(7, start + seconds(2));
  EXPECT_EQ(back(0), range(7, 7));
}

}  // namespace
}  // namespace coupler::host
