// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/output_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "coupler/device/core/watchdog.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using modbus::Change;
using modbus::Range;
using modbus::Reason;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using State = ScheduledOutput::State;

Change cancelled(Reason reason, std::uint16_t number, TimePoint at) {
  return {static_cast<std::uint8_t>(reason), Change::Kind::cancelled, number, node_time(at)};
}

class Scheduling : public testing::Test {
 protected:
  static TimePoint at(int ms) { return TimePoint(milliseconds(ms)); }

  ScheduledOutput* add(int due, Range range = Range::of(0, 1), Table table = Table::coils) {
    return add(client_, due, range, table);
  }
  ScheduledOutput* add(const ClientSession& owner, int due, Range range = Range::of(0, 1),
                       Table table = Table::coils, milliseconds duration = {}) {
    modbus::ScheduleOutput wanted;
    wanted.duration = duration;
    wanted.range = range;
    wanted.values = values_;
    return schedule_.add(wanted, table, at(due), owner);
  }
  /// The numbers of what is due until then, which is removed.
  std::vector<int> take_due(int now) {
    std::vector<int> numbers;
    while (ScheduledOutput* which = schedule_.due(at(now))) {
      numbers.push_back(which->number);
      schedule_.remove(*which);
    }
    return numbers;
  }

  ClientSession client_;
  ClientSession other_;
  std::vector<std::uint8_t> values_{0x01, 0x02, 0x03, 0x04};
  std::vector<ScheduledOutput> places_{4};
  FakeScheduleSink outcomes_;
  OutputSchedule schedule_{places_, &outcomes_};
};

TEST_F(Scheduling, Nothing_is_due_before_its_time) {
  add(10);
  EXPECT_EQ(schedule_.earliest(), at(10));
  EXPECT_EQ(schedule_.due(at(10) - TimePoint::duration(1)), nullptr);
  EXPECT_NE(schedule_.due(at(10)), nullptr);
}

TEST_F(Scheduling, What_is_due_is_in_the_order_of_its_times_and_then_of_acceptance) {
  const int late = add(20)->number;
  const int first = add(10)->number;
  const int second = add(10)->number;
  const int never = add(31)->number;
  EXPECT_THAT(take_due(30), ElementsAre(first, second, late));
  EXPECT_EQ(schedule_.earliest(), at(31));
  EXPECT_THAT(take_due(31), ElementsAre(never));
  EXPECT_EQ(schedule_.earliest(), TimePoint::max());
}

TEST_F(Scheduling, What_ends_comes_before_what_begins_at_the_same_time) {
  ScheduledOutput* begun = add(1);
  const int number = begun->number;
  schedule_.begin(*begun, at(10), std::vector<std::uint16_t>{0});
  const int next = add(10)->number;
  EXPECT_THAT(take_due(10), ElementsAre(number, next));
}

TEST_F(Scheduling, One_more_than_there_are_places_finds_none_until_one_is_free) {
  for (int i = 0; i < 4; ++i) ASSERT_NE(add(i), nullptr);
  EXPECT_EQ(add(9), nullptr);
  schedule_.remove(*schedule_.due(at(0)));
  EXPECT_NE(add(9), nullptr);
}

TEST_F(Scheduling, Durations_of_more_than_a_minute_take_half_of_the_places_at_most) {
  const auto add_one = [&](milliseconds duration) {
    return add(client_, 5, Range::of(0, 1), Table::coils, duration);
  };
  const auto longer = std::chrono::minutes(1) + milliseconds(1);
  ScheduledOutput* begun = add_one(longer);
  schedule_.begin(*begun, at(9), std::vector<std::uint16_t>{0});
  EXPECT_NE(add_one(longer), nullptr);
  EXPECT_EQ(add_one(longer), nullptr);
  EXPECT_NE(add_one(std::chrono::minutes(1)), nullptr);
  schedule_.remove(*begun);
  EXPECT_NE(add_one(longer), nullptr);
}

TEST_F(Scheduling, A_number_is_never_0_and_never_one_in_use) {
  const std::uint16_t kept = add(5)->number;
  for (int i = 0; i < 0x20000; ++i) {
    ScheduledOutput* which = add(5);
    ASSERT_NE(which->number, 0);
    ASSERT_NE(which->number, kept);
    schedule_.remove(*which);
  }
}

TEST_F(Scheduling, A_client_cancels_its_own_and_only_what_has_not_begun) {
  const std::uint16_t own = add(5)->number;
  ScheduledOutput* begun = add(6);
  schedule_.begin(*begun, at(10), std::vector<std::uint16_t>{0});
  EXPECT_FALSE(schedule_.cancel(own, other_, at(1)));
  EXPECT_FALSE(schedule_.cancel(begun->number, client_, at(1)));
  EXPECT_FALSE(schedule_.cancel(999, client_, at(1)));
  EXPECT_THAT(outcomes_.told, IsEmpty());
  EXPECT_TRUE(schedule_.cancel(own, client_, at(1)));
  EXPECT_THAT(outcomes_.told, ElementsAre(cancelled(Reason::client, own, at(1))));
  EXPECT_FALSE(schedule_.cancel(own, client_, at(1))) << "twice";
  EXPECT_EQ(schedule_.earliest(), at(10)) << "only the end of the other is left";
}

TEST_F(Scheduling, A_client_cancels_from_a_time_on_what_is_its_own_overlaps_and_has_not_begun) {
  const std::uint16_t at_the_time = add(5, Range::of(3, 2))->number;
  const std::uint16_t before = add(4, Range::of(4, 1))->number;
  const std::uint16_t others = add(other_, 6, Range::of(4, 1))->number;
  ScheduledOutput* begun = add(7, Range::of(4, 1));
  schedule_.begin(*begun, at(10), std::vector<std::uint16_t>{0});
  EXPECT_EQ(schedule_.cancel_from(at(5), Table::holding_registers, Range::of(4, 9), client_, at(1)), 0U);
  EXPECT_EQ(schedule_.cancel_from(at(5), Table::coils, Range::of(5, 9), client_, at(1)), 0U);
  EXPECT_EQ(schedule_.cancel_from(at(6), Table::coils, Range::of(4, 9), client_, at(1)), 0U);
  EXPECT_THAT(outcomes_.told, IsEmpty());
  EXPECT_EQ(schedule_.cancel_from(at(5), Table::coils, Range::of(4, 9), client_, at(1)), 1U);
  EXPECT_THAT(outcomes_.told, ElementsAre(cancelled(Reason::client, at_the_time, at(1))));
  EXPECT_THAT(take_due(9), ElementsAre(before, others));
}

TEST_F(Scheduling, The_end_of_a_connection_cancels_what_it_scheduled) {
  const std::uint16_t own = add(client_, 5)->number;
  const std::uint16_t others = add(other_, 6)->number;
  schedule_.cancel_of(client_, at(2));
  EXPECT_THAT(outcomes_.told, ElementsAre(cancelled(Reason::connection, own, at(2))));
  EXPECT_THAT(take_due(9), ElementsAre(others));
}

TEST_F(Scheduling, A_write_cancels_what_overlaps_it_in_the_same_table) {
  const std::uint16_t below = add(5, Range::of(0, 4))->number;
  const std::uint16_t hit = add(5, Range::of(4, 4))->number;
  const std::uint16_t register_there = add(5, Range::of(4, 2), Table::holding_registers)->number;
  schedule_.cancel_overlapping(Table::coils, Range::of(7, 9), at(3));
  EXPECT_THAT(outcomes_.told, ElementsAre(cancelled(Reason::overwritten, hit, at(3))));
  EXPECT_THAT(take_due(9), ElementsAre(below, register_there));
}

TEST_F(Scheduling, What_has_begun_keeps_what_was_before_as_many_values_as_a_request_can_have) {
  ScheduledOutput* bits = add(1, Range::of(0, modbus::max_scheduled_bits));
  EXPECT_EQ(bits->value(0), 1) << "what it is driven to";
  EXPECT_EQ(bits->value(9), 1);
  std::vector<std::uint16_t> before(modbus::max_scheduled_bits);
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = i % 3 == 0;
  schedule_.begin(*bits, at(10), before);
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(bits->value(i), before[i]);

  ScheduledOutput* registers =
      add(1, Range::of(0, modbus::max_scheduled_registers), Table::holding_registers);
  EXPECT_EQ(registers->value(1), 0x0304);
  std::vector<std::uint16_t> values(modbus::max_scheduled_registers, 0xFEDC);
  schedule_.begin(*registers, at(10), values);
  EXPECT_EQ(registers->value(modbus::max_scheduled_registers - 1), 0xFEDC);
}

TEST_F(Scheduling, Another_process_goes_on_with_what_has_begun_and_drops_what_waits) {
  add(3);
  ScheduledOutput* begun = add(1);
  schedule_.begin(*begun, at(10), std::vector<std::uint16_t>{1});
  OutputSchedule next(places_, &outcomes_);
  EXPECT_EQ(next.earliest(), at(10));
  EXPECT_EQ(next.due(at(9)), nullptr);
  EXPECT_EQ(next.due(at(10)), begun);
  EXPECT_THAT(outcomes_.told, IsEmpty()) << "nobody is left who could hear it";
  modbus::ScheduleOutput wanted;
  wanted.values = values_;
  for (int i = 0; i < 3; ++i)
    EXPECT_NE(next.add(wanted, Table::coils, at(1), client_)->number, begun->number);
}

}  // namespace
}  // namespace coupler::device
