// SPDX-License-Identifier: Apache-2.0
// Writes at a time to a device that has no timer: the driver's does it.
#include <gmock/gmock.h>

#include <chrono>
#include <future>
#include <new>
#include <thread>

#include "test/host/core/schedule_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Became;
using test::TimedOutputsTest;
using testing::HasSubstr;

struct ScheduledWritesTest : TimedOutputsTest {};

TEST_F(ScheduledWritesTest, It_is_written_when_its_time_has_come_and_not_before) {
  begin_foreign(press());
  const Time due = clock.now() + milliseconds(333);
  const ScheduleAnswer answer = schedule("lamp", 1, milliseconds(333));
  EXPECT_EQ(answer.number, 1U);
  EXPECT_EQ(answer.text, "accepted: the driver does it");
  run_for(milliseconds(332));
  EXPECT_EQ(lamp(), 0);
  run_for(milliseconds(2));
  EXPECT_EQ(lamp(), 1);
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.number, 1U);
  EXPECT_EQ(told.result, Became::done);
  EXPECT_EQ(told.due, due);
  EXPECT_GE(told.at.at, due);
}

TEST_F(ScheduledWritesTest, When_it_was_written_is_as_uncertain_as_the_network) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(300));
  device.reply_time = milliseconds(30);
  const Time due = clock.now() + milliseconds(300);
  run_for(milliseconds(400));
  const ScheduledOutcome told = outcome();
  ASSERT_EQ(told.result, Became::done);
  EXPECT_EQ(told.at.uncertainty, milliseconds(15));
  EXPECT_GE(told.at.at, due + milliseconds(15));
}

TEST_F(ScheduledWritesTest, Those_of_one_time_are_written_in_their_order) {
  begin_foreign(press());
  schedule("speed", 1, milliseconds(300));
  schedule("speed", 2, milliseconds(200));
  const auto at = wanted("speed", 3, milliseconds(100));
  auto later = at;
  later.write.registers[0] = 4;
  schedule(at);
  schedule(later);
  run_for(milliseconds(110));
  EXPECT_EQ(speed(), 4);
  run_for(milliseconds(100));
  EXPECT_EQ(speed(), 2);
  run_for(milliseconds(100));
  EXPECT_EQ(speed(), 1);
  ASSERT_EQ(sink->outcomes.size(), 4U);
  EXPECT_EQ(sink->outcomes[0].number, 3U);
  EXPECT_EQ(sink->outcomes[1].number, 4U);
}

TEST_F(ScheduledWritesTest, Another_write_to_the_point_cancels_it) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(300));
  push("speed", 3);
  run_for(milliseconds(10));
  EXPECT_TRUE(sink->outcomes.empty()) << "to another point";
  push("lamp", 0);
  run_for(milliseconds(10));
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.result, Became::cancelled);
  EXPECT_EQ(told.reason, "another write to the same point");
  run_for(seconds(1));
  EXPECT_EQ(lamp(), 0);
}

TEST_F(ScheduledWritesTest, A_write_that_was_queued_before_goes_before_and_does_not_cancel_it) {
  begin_foreign(press());
  push("lamp", 0);
  auto accepted = engine->schedule(wanted("lamp", 1, milliseconds(300)));
  run_for(milliseconds(10));
  EXPECT_NE(accepted.get().number, 0U);
  EXPECT_TRUE(sink->outcomes.empty());
  run_for(milliseconds(300));
  EXPECT_EQ(outcome().result, Became::done);
  EXPECT_EQ(lamp(), 1);
}

TEST_F(ScheduledWritesTest, Writes_of_other_points_hold_it_not_back) {
  begin_foreign(press());
  push("speed", 3);
  auto accepted = engine->schedule(wanted("lamp", 1, milliseconds(300)));
  auto held = engine->schedule(wanted("speed", 4, milliseconds(300)));
  engine->step();
  EXPECT_EQ(accepted.wait_for(seconds(0)), std::future_status::ready);
  EXPECT_NE(held.wait_for(seconds(0)), std::future_status::ready);
  EXPECT_EQ(device.count("write register 2"), 0U);
  run_for(milliseconds(10));
  EXPECT_EQ(held.wait_for(seconds(0)), std::future_status::ready);
}

TEST_F(ScheduledWritesTest, Writes_without_end_do_not_hold_it_back) {
  begin_foreign(press());
  push("lamp", 0);
  push("lamp", 1);
  auto accepted = engine->schedule(wanted("lamp", 1, seconds(300)));
  for (int i = 0; i < 20; ++i) during_wait_for_turn([this] { engine->step(); }, [this] { push("lamp", 0); });
  EXPECT_EQ(accepted.wait_for(seconds(0)), std::future_status::ready);
}

TEST_F(ScheduledWritesTest, The_end_of_the_connection_refuses_what_is_held_back) {
  begin_foreign(press());
  device.next_errors = {TransportFailure{"it has gone"}};
  push("lamp", 0);
  auto refused = engine->schedule(wanted("lamp", 1, milliseconds(300)));
  run_for(milliseconds(10));
  ASSERT_EQ(refused.wait_for(seconds(0)), std::future_status::ready);
  EXPECT_EQ(refused.get().number, 0U);
}

TEST_F(ScheduledWritesTest, What_was_scheduled_cancels_nothing) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(100));
  schedule("lamp", 0, milliseconds(300));
  run_for(milliseconds(200));
  EXPECT_EQ(lamp(), 1);
  run_for(milliseconds(200));
  EXPECT_EQ(lamp(), 0);
  EXPECT_EQ(sink->outcomes.size(), 2U);
}

TEST_F(ScheduledWritesTest, The_end_of_the_connection_cancels_it) {
  begin_foreign(press());
  schedule("lamp", 1, seconds(10));
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(milliseconds(200));
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.result, Became::cancelled);
  EXPECT_EQ(told.reason, "the connection ended");
  run_for(seconds(20));
  EXPECT_EQ(lamp(), 0);
}

TEST_F(ScheduledWritesTest, The_end_of_the_connection_cancels_what_is_queued_though_the_sink_has_thrown) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(50));
  schedule("lamp", 0, milliseconds(50));
  Write write = wanted("speed", 1, milliseconds(0)).write;
  write.ordered = true;
  for (std::size_t i = 0; i + 1 < WriteQueue::capacity; ++i) engine->push(write);
  clock.advance(milliseconds(50));
  sink->throwing_outcomes = 1;
  EXPECT_THROW(engine->step(), std::bad_alloc);
  engine->give_up("no memory");
  ASSERT_EQ(sink->outcomes.size(), 2U);
  EXPECT_EQ(sink->outcomes[0].number, 2U) << "there was no room for it";
  EXPECT_EQ(sink->outcomes[0].result, Became::failed);
  EXPECT_EQ(sink->outcomes[1].number, 1U);
  EXPECT_EQ(sink->outcomes[1].result, Became::cancelled);
}

TEST_F(ScheduledWritesTest, It_has_one_outcome_though_there_is_no_memory_when_its_time_has_come) {
  bool has_failed = true;
  for (long after = 0; has_failed; ++after) {
    begin_foreign(press());
    schedule("lamp", 1, milliseconds(50));
    clock.advance(milliseconds(50));
    sink->outcomes.reserve(1);
    has_failed = step_without_memory(after);
    EXPECT_EQ(outcome().number, 1U) << after;
  }
}

TEST_F(ScheduledWritesTest, What_has_no_answer_is_unknown_and_not_made_again) {
  auto builder = press();
  builder.head().on_reconnect = OnReconnect::restore;
  begin_foreign(builder);
  schedule("lamp", 1, milliseconds(50));
  device.next_errors = {Timeout{milliseconds(3000)}};
  run_for(seconds(5));
  EXPECT_EQ(outcome().result, Became::unknown);
  EXPECT_EQ(device.count("write coil 5"), 1U);
  EXPECT_EQ(lamp(), 0);
}

TEST_F(ScheduledWritesTest, An_exception_is_a_failure_with_its_words) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(50));
  device.refuses = [](const std::string& request) {
    return request == "write coil 5" ? std::optional(modbus::Exception::server_device_failure) : std::nullopt;
  };
  run_for(milliseconds(100));
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.result, Became::failed);
  EXPECT_THAT(told.reason, HasSubstr("exception 04"));
}

TEST_F(ScheduledWritesTest, A_call_withdraws_it_while_it_is_queued) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(50));
  const ScheduleAnswer kept = schedule("lamp", 1, milliseconds(50));
  clock.advance(milliseconds(50));
  auto answer = engine->cancel_scheduled(1);
  engine->step();
  const CallAnswer told = answer.get();
  EXPECT_TRUE(told.success) << told.text;
  const ScheduledOutcome became = outcome();
  EXPECT_EQ(became.number, 1U);
  EXPECT_EQ(became.result, Became::cancelled);
  EXPECT_EQ(became.reason, "its client cancelled it");
  run_for(milliseconds(50));
  EXPECT_EQ(device.count("write coil 5"), 1U);
  EXPECT_EQ(outcome().number, kept.number) << "the other one has its outcome, too";
  auto again = engine->schedule(wanted("lamp", 0, milliseconds(50)));
  run_for(milliseconds(100));
  EXPECT_NE(again.get().number, 0U) << "nothing queued before is missing its result";
}

TEST_F(ScheduledWritesTest, A_call_withdraws_it_while_it_waits_behind_another_unit) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(50));
  clock.advance(milliseconds(50));
  std::future<CallAnswer> answer;
  during_wait_for_turn([this] { engine->step(); },
                       [&] {
                         answer = engine->cancel_scheduled(1);
                         link->wake();
                         for (int i = 0; i < 20000 && shared->turns.is_awaited(); ++i)
                           std::this_thread::sleep_for(std::chrono::microseconds(100));
                       });
  EXPECT_TRUE(is_turn_free());
  run_for(milliseconds(50));
  EXPECT_TRUE(answer.get().success);
  EXPECT_EQ(outcome().result, Became::cancelled);
  EXPECT_EQ(device.count("write coil 5"), 0U);
}

TEST_F(ScheduledWritesTest, Until_a_call_has_withdrawn_it_nobody_sends_it) {
  begin_foreign(press());
  schedule("lamp", 1, milliseconds(50));
  auto answer = engine->cancel_scheduled(1);
  push("speed", 3);
  EXPECT_FALSE(engine->send_now());
  run_for(milliseconds(10));
  EXPECT_TRUE(answer.get().success);
  EXPECT_EQ(speed(), 3);
}

TEST_F(ScheduledWritesTest, The_limits_are_told_with_what_is_possible) {
  begin_foreign(press());
  EXPECT_EQ(schedule("lamp", 1, milliseconds(-5)).number, 0U);
  EXPECT_THAT(schedule("lamp", 1, seconds(-5)).text, HasSubstr("5.000 s in the past; send a future time"));
  EXPECT_THAT(schedule("lamp", 1, hours(2)).text, HasSubstr("an hour (3600 s) is the most"));
  EXPECT_THAT(schedule("lamp", 1, seconds(1), milliseconds(-1)).text, HasSubstr("send 0, for good"));
  EXPECT_THAT(schedule("lamp", 1, seconds(1), hours(2)).text, HasSubstr("up to an hour"));
  EXPECT_THAT(schedule("horn", 1, seconds(1), seconds(1)).text, HasSubstr("a second write of horn"));
  EXPECT_NE(schedule("horn", 1, seconds(1)).number, 0U);
  EXPECT_NE(schedule("lamp", 1, hours(1)).number, 0U);
  EXPECT_NE(schedule("lamp", 1, milliseconds(-1)).number, 0U) << "just past is at once";
}

TEST_F(ScheduledWritesTest, There_are_64_at_most) {
  begin_foreign(press());
  for (int i = 0; i < 64; ++i) EXPECT_NE(schedule("lamp", 1, seconds(2 + i)).number, 0U);
  EXPECT_THAT(schedule("lamp", 1, seconds(1)).text, HasSubstr("64 scheduled writes"));
  run_for(milliseconds(2001));
  EXPECT_NE(schedule("lamp", 1, seconds(1)).number, 0U);
}

TEST_F(ScheduledWritesTest, A_value_that_the_map_does_not_allow_is_refused_at_once) {
  begin_foreign(MapBuilder().holding("level", 3, codec::Type::REAL));
  ScheduledWrite what = wanted("level", 0, seconds(1));
  what.write.registers[0] = what.write.registers[1] = 0x7FFF;  // NaN
  EXPECT_THAT(schedule(what).text, HasSubstr("not finite"));
}

TEST_F(ScheduledWritesTest, Without_a_connection_it_is_refused) {
  device.refuse_connect = NotConnected{"nobody"};
  begin_foreign(press());
  const ScheduleAnswer answer = engine->schedule(wanted("lamp", 1, seconds(1))).get();
  EXPECT_EQ(answer.number, 0U);
  EXPECT_THAT(answer.text, HasSubstr("not connected: nobody; ask again when the device is back"));
}

TEST_F(ScheduledWritesTest, Safe_values_cancel_it) {
  begin_foreign(press());
  device.values[{Table::coils, 5}] = 1;
  schedule("lamp", 1, seconds(1));
  auto safe = engine->make_safe();
  run_for(milliseconds(10));
  EXPECT_EQ(outcome().result, Became::cancelled);
  run_for(seconds(5));
  EXPECT_EQ(lamp(), 0);
}

TEST_F(ScheduledWritesTest, Safe_values_refuse_a_call_that_waits) {
  begin_foreign(press());
  auto asked = engine->schedule(wanted("lamp", 1, seconds(1)));
  auto safe = engine->make_safe();
  run_for(seconds(5));
  EXPECT_TRUE(safe.get().success);
  const ScheduleAnswer answer = asked.get();
  EXPECT_EQ(answer.number, 0U);
  EXPECT_THAT(answer.text, HasSubstr("safe values have been written meanwhile"));
  EXPECT_EQ(lamp(), 0);
}

TEST_F(ScheduledWritesTest, At_the_end_of_the_driver_what_waits_is_cancelled) {
  begin_foreign(press());
  schedule("lamp", 1, seconds(10));
  EXPECT_TRUE(engine->has_to_end());
  engine->stop();
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.result, Became::cancelled);
  EXPECT_EQ(told.reason, "the driver ends");
  EXPECT_EQ(lamp(), 0);
  EXPECT_EQ(engine->schedule(wanted("lamp", 1, seconds(1))).get().number, 0U);
}

}  // namespace
}  // namespace coupler::host
