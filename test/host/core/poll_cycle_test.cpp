// SPDX-License-Identifier: Apache-2.0
#include "host/core/poll_cycle.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>
#include <string>

#include "test/fakes/map_builder.hpp"

namespace coupler::driver {
namespace {

using fakes::MapBuilder;
using std::chrono::milliseconds;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr Table hr = Table::holding_registers;
constexpr Time begin = Time{} + std::chrono::hours(1);

auto at_rate(double rate) {
  return [rate](Point& point) { point.host.rate = rate; };
}

/// A cycle, and a device in which some addresses are missing and every request takes its time.
struct PollCycleTest : testing::Test {
  void plan(MapBuilder builder) {
    owned = builder.build();
    cycle.emplace(owned->map());
    cycle->start(now);
  }

  /// One request, if one is due: "0+4", with a "!" if it was rejected.
  std::string step() {
    const ReadSpan* span = cycle->select(now);
    if (span == nullptr) return {};
    auto text = fmt::format("{}+{}", span->range.start(), span->range.count());
    now += reply_time;
    bool good = span->range.count() <= longest;
    for (std::uint32_t i = 0; i < span->range.count(); ++i)
      good = good && missing.count(span->range.start() + i) == 0;
    if (good) {
      cycle->answered(std::nullopt, now);
      return text;
    }
    for (const std::uint32_t point : cycle->rejected(now))
      given_up.push_back(std::string(owned->map().points[point].name));
    return text + "!";
  }
  /// Everything that is due, then to the next deadline.
  std::vector<std::string> run() {
    std::vector<std::string> requests;
    while (cycle->due() <= now) {
      const std::string request = step();
      if (!request.empty()) requests.push_back(request);
    }
    if (cycle->due() < Time::max()) now = cycle->due();
    return requests;
  }
  /// The requests of each of `count` steps.
  std::vector<std::string> steps(int count) {
    std::vector<std::string> requests;
    for (int i = 0; i < count; ++i) requests.push_back(step());
    return requests;
  }

  Time now = begin;
  Duration reply_time = milliseconds(1);
  std::uint32_t longest = 125;
  std::set<std::uint32_t> missing;
  std::vector<std::string> given_up;
  MapPtr owned;
  std::optional<PollCycle> cycle;
};

MapBuilder points(std::initializer_list<unsigned> addresses) {
  MapBuilder builder;
  for (const unsigned address : addresses) builder.many(hr, address, 1);
  builder.head().polling.register_continuous = true;
  return builder;
}

TEST_F(PollCycleTest, A_map_without_points_is_never_due) {
  plan(MapBuilder());
  EXPECT_EQ(cycle->due(), Time::max());
  EXPECT_EQ(cycle->select(now), nullptr);
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

TEST_F(PollCycleTest, A_rejected_request_is_parted_until_the_hole_is_found_and_the_rest_is_joined_again) {
  missing = {9};
  plan(points({0, 2, 4, 6, 8, 10, 12, 14}));
  EXPECT_THAT(run(), ElementsAre("0+15!", "0+7", "8+7!", "8+3!", "8+1", "10+1", "12+3"));
  EXPECT_THAT(run(), ElementsAre("0+9", "10+5"));
  EXPECT_THAT(given_up, IsEmpty());
  EXPECT_EQ(cycle->status().front().requests, 2U);
}

TEST_F(PollCycleTest, A_hole_is_told_once_with_what_to_add_to_the_map) {
  missing = {9};
  plan(points({0, 2, 8, 12}));
  run();
  const auto refusals = cycle->take_refusals();
  ASSERT_EQ(refusals.size(), 1U);
  EXPECT_THAT(to_string(refusals[0]),
              testing::HasSubstr("unreadable: [{table: holding_registers, from: 9, to: 11}]"));
  run();
  run();
  EXPECT_THAT(cycle->take_refusals(), IsEmpty());
}

TEST_F(PollCycleTest, Several_holes_are_found_in_one_cycle) {
  missing = {1, 11};
  plan(points({0, 2, 4, 6, 8, 10, 12, 14}));
  run();
  EXPECT_THAT(run(), ElementsAre("0+1", "2+9", "12+3"));
  EXPECT_THAT(run(), Each(Not(testing::EndsWith("!"))));
}

TEST_F(PollCycleTest, A_point_that_is_refused_by_itself_is_given_up_and_the_rest_goes_on) {
  missing = {2};
  plan(points({0, 1, 2, 3}));
  EXPECT_THAT(run(), ElementsAre("0+4!", "0+2", "2+2!", "2+1!", "3+1"));
  EXPECT_THAT(given_up, ElementsAre("holding_registers_2"));
  EXPECT_THAT(run(), ElementsAre("0+2", "3+1"));
  EXPECT_THAT(cycle->take_refusals(), IsEmpty()) << "the point has been told";
}

TEST_F(PollCycleTest, All_bits_of_a_refused_register_are_given_up_with_one_request) {
  missing = {0};
  MapBuilder builder;
  for (std::uint8_t bit = 0; bit < 3; ++bit)
    builder.add(hr, std::string("bit") + char('a' + bit), 0, codec::Type::BOOL,
                [bit](Point& point) { point.format.bit = bit; });
  plan(builder);
  EXPECT_THAT(run(), ElementsAre("0+1!"));
  EXPECT_THAT(given_up, ElementsAre("bita", "bitb", "bitc"));
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(PollCycleTest, A_device_that_takes_fewer_than_the_map_says_is_asked_for_less) {
  longest = 40;
  plan(MapBuilder().many(hr, 0, 100));
  EXPECT_THAT(run(), ElementsAre("0+100!", "0+50!", "0+25", "25+25", "50+50!", "50+25", "75+25"));
  EXPECT_THAT(run(), ElementsAre("0+25", "25+25", "50+25", "75+25"));
  const auto refusals = cycle->take_refusals();
  ASSERT_EQ(refusals.size(), 2U);
  EXPECT_THAT(to_string(refusals[0]), testing::HasSubstr("limits: {read_registers: …}"));
}

TEST_F(PollCycleTest, A_function_that_the_device_does_not_know_is_not_tried_again) {
  plan(points({0, 1}));
  cycle->select(now);
  cycle->give_up(now);
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(PollCycleTest, With_a_new_connection_everything_is_asked_for_again) {
  missing = {2};
  plan(points({0, 1, 2, 3}));
  run();
  cycle->start(now);
  EXPECT_THAT(run(), Contains("0+4!"));
}

TEST_F(PollCycleTest, An_answer_is_news_when_it_differs_from_the_last) {
  plan(points({0}));
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
  plan(points({0, 1, 2, 100}));
  cycle->want(0, false);
  cycle->want(3, false);
  run();
  EXPECT_THAT(run(), ElementsAre("1+2"));
  cycle->want(3, true);
  EXPECT_THAT(run(), ElementsAre("1+2", "100+1"));
}

TEST_F(PollCycleTest, Nobody_wants_anything_no_request_is_made) {
  plan(points({0, 1}));
  cycle->want(0, false);
  cycle->want(1, false);
  EXPECT_THAT(run(), IsEmpty());
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(PollCycleTest, The_first_who_wants_something_has_it_at_once) {
  plan(points({0, 1}));
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
  plan(points({0, 100, 200}));
  EXPECT_EQ(step(), "0+1");
  cycle->want(1, false);
  EXPECT_THAT(steps(3), ElementsAre("100+1", "200+1", ""));
  now = cycle->due();
  EXPECT_THAT(run(), ElementsAre("0+1", "200+1"));
}

TEST_F(PollCycleTest, What_was_learned_is_kept_when_wishes_change) {
  missing = {1};
  plan(points({0, 2, 4}));
  run();
  cycle->want(2, false);
  EXPECT_THAT(run(), ElementsAre("0+1", "2+1"));
}

}  // namespace
}  // namespace coupler::driver
