// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/waits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string_view>
#include <vector>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using End = WaitResult::End;
using std::chrono::milliseconds;
using testing::HasSubstr;

struct WaitsTest : testing::Test {
  WaitsTest() {
    values.begin();
    values.online(true);
  }
  static Time at(int ms) { return Time(milliseconds(ms)); }

  /// The device has been read at this time.
  void read(int ms, std::uint16_t value, bool is_told = false) {
    const ReadSpan span{Table::holding_registers, modbus::Range::of(0, 1), {0}};
    values.store(span, {&value, 1}, {at(ms), milliseconds(1)}, at(ms));
    const std::uint32_t point = 0;
    waits.on_values({&point, 1}, is_told);
  }
  std::uint64_t begin(int ms, std::string_view relation, std::string_view value, int for_at_least = 0,
                      std::optional<int> since = {}) {
    waits.begin(++last_number,
                {0, *Condition::parse(map->map().points[0], relation, value), milliseconds(for_at_least),
                 at(since.value_or(ms)), at(ms + 5000)},
                at(ms), [this](const WaitResult& result) { results.push_back(result); });
    return last_number;
  }
  Time step(int ms) { return waits.step(at(ms)); }

  MapPtr map = fakes::MapBuilder().holding("x", 0).build();
  ValueTable values{map->map()};
  std::uint64_t last_number = 0;
  int woken = 0;
  std::vector<std::uint32_t> asked;
  Waits waits{map->map(), values, at(-1), [this] { ++woken; },
              [this](std::uint32_t point) { asked.push_back(point); }};
  std::vector<WaitResult> results;
};

TEST_F(WaitsTest, A_condition_that_comes_true_gives_its_value_and_stamp) {
  begin(1000, "==", "5");
  read(1100, 4);
  step(1100);
  EXPECT_TRUE(results.empty());
  read(1200, 5);
  step(1201);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::met);
  EXPECT_EQ(results[0].value, "5");
  EXPECT_EQ(results[0].stamp.at, at(1200));
  EXPECT_EQ(results[0].stamp.uncertainty, milliseconds(1));
  step(99999);
  EXPECT_EQ(results.size(), 1U);
}

TEST_F(WaitsTest, What_was_read_before_the_goal_does_not_meet_it) {
  read(900, 5);
  begin(1000, "==", "5");
  step(1001);
  EXPECT_TRUE(results.empty());
}

TEST_F(WaitsTest, An_edge_after_the_goal_was_received_counts_though_its_wait_begins_later) {
  read(900, 0);
  read(1001, 9, true);
  begin(1000, "rises", "5");
  step(1002);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].stamp.at, at(1001));
}

TEST_F(WaitsTest, A_time_that_has_passed_ends_it_with_the_value) {
  begin(1000, "==", "5");
  read(5900, 4);
  EXPECT_LE(step(5999), at(6000));
  step(6000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::not_met);
  EXPECT_EQ(results[0].reason, "timed out; x is 4");
}

TEST_F(WaitsTest, A_point_that_is_not_read_in_time_is_said) {
  begin(1000, "==", "5");
  step(6000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason, "timed out before x was read");
}

TEST_F(WaitsTest, What_happened_since_a_time_counts_though_it_is_over) {
  read(700, 0);
  read(800, 9);
  read(900, 0);
  begin(1000, "rises", "5", 0, 750);
  step(1000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::met);
  EXPECT_EQ(results[0].stamp.at, at(800));
}

TEST_F(WaitsTest, What_happened_before_that_time_does_not_count) {
  read(700, 0);
  read(800, 9);
  read(900, 0);
  begin(1000, "rises", "5", 0, 850);
  step(1000);
  EXPECT_TRUE(results.empty());
}

TEST_F(WaitsTest, A_value_that_may_have_ended_before_that_time_does_not_count) {
  read(100, 9);
  read(1000, 0);  // it has fallen at some time in between
  begin(1100, ">", "5", 0, 900);
  step(1100);
  EXPECT_TRUE(results.empty());
}

TEST_F(WaitsTest, A_value_that_was_there_until_an_announced_change_counts) {
  read(100, 9);
  read(1000, 0, true);
  begin(1100, ">", "5", 0, 900);
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::met);
}

TEST_F(WaitsTest, What_has_held_long_enough_since_that_time_counts_though_it_is_over) {
  read(100, 0);
  read(200, 9, true);
  read(1000, 0, true);
  begin(1100, ">", "5", 500, 150);
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].stamp.at, at(200));
}

TEST_F(WaitsTest, An_edge_after_an_interruption_counts_and_the_interruption_is_none) {
  const std::uint32_t point = 0;
  read(100, 0);
  waits.on_no_values({&point, 1}, at(150));
  read(200, 9);
  begin(300, "rises", "5", 0, 120);
  step(300);
  EXPECT_TRUE(results.empty());
  read(400, 0);
  read(500, 9);
  step(500);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].stamp.at, at(500));
}

TEST_F(WaitsTest, Changes_that_the_device_has_lost_interrupt_what_holds) {
  begin(1000, ">", "5", 300);
  read(1100, 9);
  waits.on_gap();
  read(1401, 9);
  step(1401);
  EXPECT_TRUE(results.empty());
}

TEST_F(WaitsTest, An_announced_change_just_after_the_first_reading_counts) {
  begin(1000, "==", "5");
  read(1002, 4);
  const ReadSpan span{Table::holding_registers, modbus::Range::of(0, 1), {0}};
  const std::uint16_t five = 5;
  values.store(span, {&five, 1}, {at(1003), milliseconds(10)}, at(1003));  // a clock that is not known well
  const std::uint32_t point = 0;
  waits.on_values({&point, 1}, true);
  step(1003);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::met);
}

TEST_F(WaitsTest, An_exception_from_before_the_goal_does_not_end_it) {
  const std::uint32_t point = 0;
  values.exception({&point, 1}, modbus::Exception::server_device_busy);
  begin(1000, "==", "5");
  step(1000);
  EXPECT_TRUE(results.empty());
  waits.on_no_values({&point, 1}, at(1100));
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason, "x has no value, it is exception: exception 06");
}

TEST_F(WaitsTest, A_value_from_before_an_interruption_does_not_hold_through_it) {
  read(700, 0);
  read(800, 9);
  const std::uint32_t point = 0;
  waits.on_no_values({&point, 1}, at(850));
  begin(1000, ">", "5", 300, 750);
  read(1150, 9);
  step(1150);
  EXPECT_TRUE(results.empty());
  read(1450, 9);
  step(1450);
  ASSERT_EQ(results.size(), 1U);
}

TEST_F(WaitsTest, A_change_since_an_old_reading_is_no_event) {
  read(0, 0);
  waits.on_wanted(0);
  begin(100000, "rises", "5");  // nobody has read it meanwhile
  read(100010, 9);
  step(100010);
  EXPECT_TRUE(results.empty());
}

TEST_F(WaitsTest, What_happened_while_nobody_read_it_cannot_be_asked_for) {
  read(0, 0);
  waits.on_wanted(0);
  begin(100000, "rises", "5", 0, 90000);
  step(100000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason, "x was not read before the goal came; leave 'since' out");
}

TEST_F(WaitsTest, An_offline_device_ends_it_at_once) {
  begin(1000, "==", "5");
  values.online(false);
  waits.on_online(false, at(1100));
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::not_met);
  EXPECT_EQ(results[0].reason, "the device of x is offline");
}

TEST_F(WaitsTest, A_point_that_the_device_rejects_ends_it_at_once) {
  begin(1000, "==", "5");
  const std::uint32_t point = 0;
  values.rejected({&point, 1}, modbus::Exception::illegal_data_address);
  waits.on_no_values({&point, 1}, at(1100));
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason, "x has no value, it is rejected: exception 02");
}

TEST_F(WaitsTest, A_value_that_has_become_stale_ends_it) {
  begin(1000, "==", "5");
  read(1100, 4);
  const Time stale = values.quality(0, at(1100)).stale_from;
  EXPECT_LE(step(1100), stale + Duration(1));
  waits.step(stale + Duration(1));
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason, "x has not been read lately");
}

TEST_F(WaitsTest, The_device_is_asked_when_a_condition_has_held_long_enough) {
  begin(1000, "==", "5", 300);
  read(1100, 5);
  EXPECT_EQ(step(1100), at(1400));
  EXPECT_EQ(asked.size(), 1U) << "when the goal came";
  EXPECT_GT(step(1400), at(1400));
  EXPECT_EQ(asked.size(), 2U);
  EXPECT_TRUE(results.empty());  // it may have changed without having been told yet
  read(1401, 5);
  step(1401);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].stamp.at, at(1100));
}

TEST_F(WaitsTest, It_is_cancelled_once) {
  const auto number = begin(1000, "==", "5");
  read(1100, 4);
  waits.cancel(number);
  waits.cancel(number);
  step(1100);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].end, End::cancelled);
  EXPECT_EQ(results[0].value, "4");
}

TEST_F(WaitsTest, The_end_of_the_driver_ends_all_and_those_to_come) {
  begin(1000, "==", "5");
  waits.end("the driver ends");
  begin(1001, "==", "5");
  step(1001);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[1].reason, "the driver ends");
}

TEST_F(WaitsTest, No_more_than_64_wait_at_a_time) {
  for (std::size_t i = 0; i <= Waits::most; ++i) begin(1000, "==", "5");
  step(1000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_THAT(results[0].reason, HasSubstr("64 goals wait already"));
}

}  // namespace
}  // namespace coupler::host
