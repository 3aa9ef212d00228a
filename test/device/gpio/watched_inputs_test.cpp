// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/watched_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coupler/map/point.hpp"
#include "test/device/gpio/line_news.hpp"

namespace coupler::device {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

/// Two lines; the second one is debounced, with 10 ms. The first one counts.
class Events : public testing::Test {
 protected:
  class Group : public WatchedInputs {
   public:
    explicit Group(const std::vector<LineSpec>& lines) : WatchedInputs(lines, std::array{0, 0}) {}
    using WatchedInputs::check;
    using WatchedInputs::edge;
    using WatchedInputs::error;
    using WatchedInputs::fail;
    using WatchedInputs::fail_all;
    using WatchedInputs::look;
    using WatchedInputs::lose;
    const std::string& name() const override { return name_; }
    int read(Span<int> levels, TimePoint now) override {
      put_levels(levels, now);
      return 0;
    }

   private:
    std::string name_ = "chip0";
  };

  static Point debounced() {
    Point point;
    point.line.debounce = 10ms;
    return point;
  }
  std::vector<Told> told(int ms) {
    group_.tell(at(ms), sink_);
    return std::exchange(sink_.all, {});
  }

  Point plain_{};
  Point debounced_ = debounced();
  Group group_{{{&plain_, {}, Edge::rising}, {&debounced_, {}, std::nullopt}}};
  LineNews sink_;
};

TEST_F(Events, Each_edge_is_a_change_at_its_own_time_and_told_once) {
  group_.edge(0, true, at(1));
  group_.edge(0, false, at(2));
  EXPECT_EQ(group_.next_change(at(5)), at(5)) << "they wait to be told";
  EXPECT_THAT(told(5), ElementsAre(Told(0, true, at(1)), Told(0, false, at(2))));
  EXPECT_THAT(sink_.counted, ElementsAre(std::pair(0, 1)));
  EXPECT_THAT(told(6), IsEmpty());
  EXPECT_EQ(group_.next_change(at(6)), std::nullopt);
}

TEST_F(Events, A_debounced_level_is_told_when_it_has_settled_since_the_edge_that_brought_it) {
  group_.edge(1, true, at(0));
  group_.edge(1, false, at(2));
  group_.edge(1, true, at(3));
  EXPECT_EQ(group_.next_change(at(4)), at(13));
  EXPECT_THAT(told(12), IsEmpty());
  EXPECT_THAT(told(13), ElementsAre(Told(1, true, at(3))));
  EXPECT_THAT(sink_.counted, IsEmpty()) << "nobody counts it";
}

TEST_F(Events, A_level_that_was_read_has_been_told_or_will_be) {
  group_.edge(1, true, at(0));
  std::vector<int> levels(2);
  EXPECT_EQ(group_.read(levels, at(20)), 0);
  EXPECT_THAT(levels, ElementsAre(0, 1));
  EXPECT_THAT(told(20), ElementsAre(Told(1, true, at(0))));
}

TEST_F(Events, Equal_edges_in_a_row_hide_a_change_that_is_lost) {
  group_.edge(0, true, at(1));
  group_.edge(0, true, at(2));
  EXPECT_THAT(told(5), ElementsAre(Told(0, true, at(1))));
  EXPECT_EQ(sink_.lost_changes, 2U) << "and so is the change back, which nobody can tell from none";
  EXPECT_THAT(sink_.counted, ElementsAre(std::pair(0, 2)));
}

TEST_F(Events, What_is_told_and_what_is_lost_is_what_was_made) {
  group_.edge(0, true, at(1));
  group_.lose(0, 1);
  group_.edge(0, true, at(3));
  EXPECT_THAT(told(3), ElementsAre(Told(0, true, at(1))));
  EXPECT_EQ(sink_.lost_changes, 2U) << "off and on";
  group_.lose(0, 2);
  group_.edge(0, false, at(6));
  EXPECT_THAT(told(6), ElementsAre(Told(0, false, at(6))));
  EXPECT_EQ(sink_.lost_changes, 4U);
}

TEST_F(Events, What_the_kernel_dropped_is_lost) {
  group_.lose(0, 7);
  EXPECT_THAT(told(5), IsEmpty());
  EXPECT_EQ(sink_.lost_changes, 7U);
  group_.lose(1, 7);
  told(6);
  EXPECT_EQ(sink_.lost_changes, 8U) << "how many of them were bouncing, nobody knows";
}

TEST_F(Events, A_level_that_no_edge_told_is_a_change_when_it_was_seen) {
  group_.look(0, false, at(1));
  EXPECT_THAT(told(1), IsEmpty()) << "no news";
  group_.look(0, true, at(2));
  EXPECT_THAT(told(2), ElementsAre(Told(0, true, at(2))));
  EXPECT_THAT(sink_.counted, ElementsAre(std::pair(0, 1)));
}

TEST_F(Events, An_edge_that_is_reported_after_its_level_was_seen_is_told_once) {
  group_.look(0, true, at(2));
  group_.edge(0, true, at(1));
  group_.edge(0, false, at(3));
  EXPECT_THAT(told(5), ElementsAre(Told(0, true, at(2)), Told(0, false, at(3))));
  EXPECT_EQ(sink_.lost_changes, 0U);
}

TEST_F(Events, A_level_whose_edge_is_on_its_way_is_told_once_at_the_time_of_the_edge) {
  group_.check(0, true, at(1));
  EXPECT_THAT(told(1), IsEmpty());
  EXPECT_EQ(group_.next_change(at(1)), at(21)) << "then it is checked again";
  group_.edge(0, true, at(2));
  EXPECT_THAT(told(3), ElementsAre(Told(0, true, at(2))));
  EXPECT_THAT(sink_.counted, ElementsAre(std::pair(0, 1)));
  EXPECT_EQ(sink_.lost_changes, 0U);
  EXPECT_EQ(group_.next_change(at(3)), std::nullopt);
}

TEST_F(Events, A_level_that_no_edge_has_told_for_20_ms_is_a_change) {
  group_.check(0, true, at(1));
  group_.check(0, true, at(20));
  EXPECT_THAT(told(20), IsEmpty());
  group_.check(0, true, at(21));
  EXPECT_THAT(told(21), ElementsAre(Told(0, true, at(21))));
  EXPECT_EQ(group_.next_change(at(21)), std::nullopt);
}

TEST_F(Events, A_line_that_cannot_be_looked_at_is_tried_again_but_not_at_once) {
  group_.check(0, true, at(1));
  group_.fail(0, EIO, at(21));
  EXPECT_EQ(group_.next_change(at(22)), at(22)) << "one is lost, for once";
  EXPECT_THAT(told(22), IsEmpty());
  EXPECT_EQ(group_.next_change(at(22)), at(41));
  group_.fail(0, EIO, at(41));
  EXPECT_EQ(group_.next_change(at(41)), at(61));
  EXPECT_EQ(group_.error(), EIO);
  group_.check(0, true, at(61));
  EXPECT_THAT(told(61), ElementsAre(Told(0, true, at(61))));
  EXPECT_EQ(group_.next_change(at(61)), std::nullopt);
  EXPECT_EQ(group_.error(), 0);
  EXPECT_EQ(sink_.lost_changes, 1U);
}

TEST_F(Events, Lines_that_fail_together_are_one_loss) {
  group_.fail_all(EIO, at(1));
  told(1);
  EXPECT_EQ(sink_.lost_changes, 1U);
}

TEST_F(Events, A_level_that_went_back_is_forgotten) {
  group_.check(0, true, at(1));
  group_.check(0, false, at(5));
  group_.check(0, true, at(30));
  EXPECT_THAT(told(30), IsEmpty());
  EXPECT_EQ(group_.next_change(at(30)), at(50));
}

TEST_F(Events, Changes_of_one_line_are_told_in_the_order_of_time) {
  group_.look(0, true, at(5));
  group_.edge(0, false, at(4));
  EXPECT_THAT(told(6), ElementsAre(Told(0, true, at(5)), Told(0, false, at(5))));
}

TEST_F(Events, The_newest_ones_are_kept_if_nobody_asks_for_them) {
  constexpr int made = 5000;
  for (int i = 1; i <= made; ++i) group_.edge(0, i % 2 == 1, at(i));
  const auto all = told(made);
  EXPECT_EQ(all.back(), Told(0, false, at(made)));
  EXPECT_EQ(all.size() + sink_.lost_changes, std::size_t{made});
  EXPECT_THAT(sink_.counted, ElementsAre(std::pair(0, made / 2))) << "all are counted";
}

TEST_F(Events, Of_those_that_are_kept_the_first_one_brings_another_level_than_was_told_last) {
  constexpr int made = 5001;
  for (int i = 1; i <= made; ++i) group_.edge(0, i % 2 == 1, at(i));
  const auto all = told(made);
  EXPECT_TRUE(std::get<bool>(all.front()));
  EXPECT_EQ(all.size() + sink_.lost_changes, std::size_t{made});
}

TEST_F(Events, What_a_process_that_died_had_taken_the_next_one_tells_once) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    group_.edge(0, true, at(1));
    ::_exit(0);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(group_.level(0), true);
  EXPECT_THAT(told(5), ElementsAre(Told(0, true, at(1))));
}

}  // namespace
}  // namespace coupler::device
