// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/poll_cycle.hpp"

#include <gmock/gmock.h>

#include <map>
#include <string>

#include "test/host/core/poll_cycle_fixture.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using std::chrono::milliseconds;
using test::PollCycleTest;
using test::registers;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Table hr = Table::holding_registers;

auto at_rate(double rate) {
  return [rate](Point& point) { point.host.rate = rate; };
}

TEST_F(PollCycleTest, A_map_without_points_is_never_due) {
  plan(MapBuilder());
  EXPECT_EQ(cycle->due(), Time::max());
  EXPECT_EQ(cycle->select(now), nullptr);
}

TEST_F(PollCycleTest, What_was_given_up_is_asked_for_again_when_the_device_may_have_changed) {
  missing = {1};
  plan(registers({0, 1}));
  run();
  ASSERT_THAT(given_up, testing::SizeIs(1));
  EXPECT_THAT(run(), ElementsAre("0+1"));
  missing.clear();
  cycle->try_again();
  EXPECT_THAT(run(), ElementsAre("0+2"));
  EXPECT_THAT(run(), ElementsAre("0+2"));
}

TEST_F(PollCycleTest, Each_rate_has_deadlines_of_its_own) {
  plan(MapBuilder()
           .add(hr, "fast", 0, codec::Type::UINT, at_rate(50))
           .add(hr, "slow", 9, codec::Type::UINT, at_rate(10)));
  EXPECT_THAT(run(), ElementsAre("0+1", "9+1"));
  EXPECT_EQ(now, begin + milliseconds(20));
  for (int i = 1; i < 5; ++i) EXPECT_THAT(run(), ElementsAre("0+1"));
  EXPECT_EQ(now, begin + milliseconds(100));
  EXPECT_THAT(run(), ElementsAre("0+1", "9+1"));
  EXPECT_EQ(cycle->overruns(), 0U);
}

TEST_F(PollCycleTest, A_slow_rate_with_many_requests_delays_a_fast_one_by_one_request) {
  auto builder = MapBuilder().add(hr, "fast", 0, codec::Type::UINT, at_rate(100));
  for (unsigned i = 1; i <= 20; ++i)
    builder.add(hr, "slow" + std::to_string(i), static_cast<std::uint16_t>(1000 * i), codec::Type::UINT,
                at_rate(1));
  plan(builder);
  reply_time = milliseconds(4);
  int since = 0;
  for (int i = 0; i < 30; ++i) {
    since = step() == "0+1" ? 0 : since + 1;
    EXPECT_LE(since, 2) << "10 ms are over after two more requests";
  }
  EXPECT_EQ(cycle->overruns(), 0U);
}

TEST_F(PollCycleTest, A_rate_that_is_too_fast_does_not_starve_the_others) {
  plan(MapBuilder()
           .add(hr, "fast", 0, codec::Type::UINT, at_rate(1000))
           .add(hr, "slow", 10, codec::Type::UINT, at_rate(20))
           .add(hr, "slower", 20, codec::Type::UINT, at_rate(10)));
  reply_time = milliseconds(3);
  std::map<std::string, int> count;
  while (now < begin + milliseconds(1000)) {
    ++count[step()];
    now = std::max(now, cycle->due());
  }
  EXPECT_EQ(count["10+1"], 20);
  EXPECT_EQ(count["20+1"], 10);
  EXPECT_GT(count["0+1"], 200) << "a request in 3 ms, then the next full millisecond";
}

TEST_F(PollCycleTest, Overruns_are_counted_for_each_rate) {
  plan(MapBuilder()
           .add(hr, "fast", 0, codec::Type::UINT, at_rate(1000))
           .add(hr, "slow", 10, codec::Type::UINT, at_rate(1)));
  reply_time = milliseconds(3);
  while (now < begin + milliseconds(100)) {
    step();
    now = std::max(now, cycle->due());
  }
  const auto status = cycle->status();
  ASSERT_EQ(status.size(), 2U);
  EXPECT_GT(status[0].overruns, 60U);
  EXPECT_EQ(status[1].overruns, 0U);
  EXPECT_EQ(cycle->overruns(), status[0].overruns);
}

TEST_F(PollCycleTest, An_answer_is_news_when_it_differs_from_the_last) {
  plan(registers({0}));
  const auto answer = [this](std::optional<modbus::Exception> exception) {
    cycle->select(now);
    const bool news = cycle->answered(exception, now);
    now = cycle->due();
    return news;
  };
  EXPECT_FALSE(answer(std::nullopt));
  EXPECT_TRUE(answer(modbus::Exception::server_device_busy));
  EXPECT_FALSE(answer(modbus::Exception::server_device_busy));
  EXPECT_TRUE(answer(std::nullopt));
}

TEST_F(PollCycleTest, Only_what_is_wanted_is_read) {
  plan(registers({0, 1, 2, 100}));
  cycle->want(0, false);
  cycle->want(3, false);
  run();
  EXPECT_THAT(run(), ElementsAre("1+2"));
  cycle->want(3, true);
  EXPECT_THAT(run(), ElementsAre("1+2", "100+1"));
}

TEST_F(PollCycleTest, Nobody_wants_anything_no_request_is_made) {
  plan(registers({0, 1}));
  cycle->want(0, false);
  cycle->want(1, false);
  EXPECT_THAT(run(), IsEmpty());
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(PollCycleTest, The_first_who_wants_something_has_it_at_once) {
  plan(registers({0, 1}));
  cycle->want(0, false);
  cycle->want(1, false);
  run();
  now += std::chrono::seconds(100);
  cycle->want(1, true);
  EXPECT_LE(cycle->due(), now);
  EXPECT_THAT(run(), ElementsAre("1+1"));
  EXPECT_EQ(cycle->overruns(), 0U) << "nothing was due meanwhile";
}

TEST_F(PollCycleTest, A_wish_that_changes_in_a_running_cycle_changes_the_next_one) {
  plan(registers({0, 100, 200}));
  EXPECT_EQ(step(), "0+1");
  cycle->want(1, false);
  EXPECT_THAT(steps(3), ElementsAre("100+1", "200+1", ""));
  now = cycle->due();
  EXPECT_THAT(run(), ElementsAre("0+1", "200+1"));
}

TEST_F(PollCycleTest, What_was_learned_is_kept_when_wishes_change) {
  missing = {1};
  plan(registers({0, 2, 4}));
  run();
  cycle->want(2, false);
  EXPECT_THAT(run(), ElementsAre("0+1", "2+1"));
}

}  // namespace
}  // namespace coupler::host
