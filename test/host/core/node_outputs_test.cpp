// SPDX-License-Identifier: Apache-2.0
// Outputs at a time: the node's timer does it, and tells what became of it.
#include <gmock/gmock.h>

#include <algorithm>
#include <future>
#include <new>

#include "test/host/core/schedule_fixture.hpp"

namespace coupler::host {
namespace {

using modbus::Reason;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Became;
using test::TimedOutputsTest;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = modbus::Change::Kind;

struct NodeOutputsTest : TimedOutputsTest {};

TEST_F(NodeOutputsTest, The_node_gets_the_time_on_its_clock_the_value_and_the_duration) {
  begin_node(press());
  const Time due = clock.now() + seconds(3);
  const ScheduleAnswer answer = schedule("speed", 0x1234, seconds(3), milliseconds(70));
  EXPECT_EQ(answer.number, 1U);
  EXPECT_EQ(answer.text, "accepted: the device does it");
  ASSERT_EQ(device.scheduled.size(), 1U);
  const modbus::ScheduleOutput& got = device.scheduled[0];
  EXPECT_EQ(got.epoch, device.epoch);
  EXPECT_LE(std::chrono::abs(got.due - due.time_since_epoch()), milliseconds(5));
  EXPECT_EQ(got.duration, milliseconds(70));
  EXPECT_EQ(got.table, modbus::Function::read_holding_registers);
  EXPECT_EQ(got.range, modbus::Range::of(2, 1));
  EXPECT_THAT(device.scheduled_values, ElementsAre(0x12, 0x34));
  run_for(seconds(10));
  EXPECT_EQ(device.count("write register 2"), 0U);
}

TEST_F(NodeOutputsTest, A_call_right_after_the_connect_is_for_the_node_too) {
  serve(press());
  device.schedule_outputs();
  start(press());
  engine->step();
  auto asked = engine->schedule(wanted("speed", 7, seconds(3), milliseconds(70)));
  run_for(milliseconds(10));
  EXPECT_EQ(asked.get().text, "accepted: the device does it");
}

TEST_F(NodeOutputsTest, What_the_node_tells_is_the_outcome) {
  begin_node(press());
  for (int i = 0; i < 3; ++i) schedule("lamp", 1, milliseconds(500));
  run_for(milliseconds(500));
  const Time now = clock.now();
  device.decide(1, Kind::done);
  device.decide(2, Kind::cancelled, Reason::watchdog);
  device.decide(3, Kind::failed, Reason::hardware);
  device.decide(4, Kind::done);  // another client's
  run_for(milliseconds(1));
  ASSERT_EQ(sink->outcomes.size(), 3U);
  EXPECT_EQ(sink->outcomes[0].result, Became::done);
  EXPECT_EQ(sink->outcomes[0].reason, "");
  EXPECT_LE(std::chrono::abs(sink->outcomes[0].at.at - now), sink->outcomes[0].at.uncertainty);
  EXPECT_EQ(sink->outcomes[1].result, Became::cancelled);
  EXPECT_EQ(sink->outcomes[1].reason, "the watchdog expired");
  EXPECT_EQ(sink->outcomes[2].result, Became::failed);
  EXPECT_EQ(sink->outcomes[2].reason, "the output could not be driven, or does not take the value");
}

TEST_F(NodeOutputsTest, Changes_of_bits_are_heard_of_meanwhile) {
  begin_node(press());
  schedule("lamp", 1, milliseconds(500));
  sink->values.clear();
  device.change(Table::coils, 5, true);
  device.decide(1, Kind::done);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["lamp"], ElementsAre(1));
}

TEST_F(NodeOutputsTest, An_exception_is_told_with_its_remedy) {
  begin_node(press());
  std::optional<modbus::Exception> code = modbus::Exception::server_device_busy;
  device.refuses = [&code](const std::string& request) {
    return request == "schedule" ? code : std::nullopt;
  };
  ScheduleAnswer answer = schedule("lamp", 1, seconds(1));
  EXPECT_EQ(answer.number, 0U);
  EXPECT_THAT(answer.text, HasSubstr("exception 06"));
  EXPECT_THAT(answer.text, HasSubstr("ask again when one of them is over"));
  code = modbus::Exception::illegal_data_value;
  EXPECT_THAT(schedule("lamp", 1, seconds(1)).text,
              HasSubstr("its time had passed when the request arrived"));
  code = modbus::Exception::server_device_failure;
  EXPECT_THAT(schedule("lamp", 1, seconds(1)).text, HasSubstr("until it is reset"));
  code.reset();
  EXPECT_NE(schedule("lamp", 1, seconds(1)).number, 0U) << "the connection is as before";
}

TEST_F(NodeOutputsTest, A_node_that_cannot_after_all_has_it_done_by_the_driver) {
  begin_node(press());
  device.refuses = [](const std::string& request) {
    return request == "schedule" ? std::optional(modbus::Exception::illegal_function) : std::nullopt;
  };
  EXPECT_EQ(schedule("lamp", 1, milliseconds(100)).text, "accepted: the driver does it");
  EXPECT_EQ(schedule("lamp", 0, milliseconds(300)).text, "accepted: the driver does it");
  EXPECT_EQ(device.count("schedule"), 1U) << "both are of one point";
  EXPECT_EQ(schedule("horn", 0, milliseconds(300)).text, "accepted: the driver does it");
  EXPECT_EQ(device.count("schedule"), 2U) << "the refusal may be about one output";
  run_for(milliseconds(110));
  EXPECT_EQ(lamp(), 1);
}

TEST_F(NodeOutputsTest, Where_the_wait_is_refused_with_the_same_answer_the_outcome_is_unknown) {
  begin_node(press());
  device.refuses_waits = modbus::Exception::illegal_function;  // by a gateway that has waited for long enough
  EXPECT_NE(schedule("lamp", 1, seconds(5)).number, 0U);
  EXPECT_EQ(outcome().result, Became::unknown);
}

TEST_F(NodeOutputsTest, With_changes_off_the_driver_does_it) {
  auto builder = press();
  builder.head().changes = false;
  begin_node(builder);
  EXPECT_EQ(schedule("lamp", 1, milliseconds(100)).text, "accepted: the driver does it");
}

TEST_F(NodeOutputsTest, A_part_of_a_register_is_for_the_driver) {
  begin_node(MapBuilder().holding("half", 3, fakes::half(codec::Type::USINT, codec::Half::low)));
  EXPECT_EQ(schedule("half", 1, milliseconds(100)).text, "accepted: the driver does it");
}

TEST_F(NodeOutputsTest, With_the_connection_the_outcome_is_lost) {
  begin_node(press());
  schedule("lamp", 1, seconds(10));
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(seconds(2));
  const ScheduledOutcome told = outcome();
  EXPECT_EQ(told.result, Became::unknown);
  EXPECT_THAT(told.reason, HasSubstr("the connection ended before the outcome was reported"));
}

TEST_F(NodeOutputsTest, An_outcome_among_changes_that_were_lost_is_unknown) {
  begin_node(press());
  schedule("lamp", 1, seconds(1));
  run_for(milliseconds(900));
  device.decide(1, Kind::done);
  device.forgotten = device.changes.size();
  run_for(milliseconds(500));
  EXPECT_TRUE(sink->outcomes.empty());
  run_for(seconds(5));
  EXPECT_EQ(outcome().result, Became::unknown);
}

TEST_F(NodeOutputsTest, A_number_that_is_given_again_had_an_outcome_which_was_lost) {
  begin_node(press());
  schedule("lamp", 1, milliseconds(20));
  run_for(milliseconds(30));
  device.scheduled.clear();
  schedule("speed", 7, seconds(1));
  ScheduledOutcome told = outcome();
  EXPECT_EQ(told.number, 1U);
  EXPECT_EQ(told.result, Became::unknown);
  device.decide(1, Kind::done);
  run_for(milliseconds(10));
  told = outcome();
  EXPECT_EQ(told.number, 2U);
  EXPECT_EQ(told.result, Became::done);
}

TEST_F(NodeOutputsTest, Where_more_changes_follow_without_end_an_outcome_is_unknown_all_the_same) {
  begin_node(press());
  schedule("lamp", 1, seconds(1));
  device.during_wait = [this] {
    clock.advance(milliseconds(10));
    for (int i = 0; i < 19; ++i) device.change(Table::coils, 5, i % 2 == 0);
  };
  run_for(seconds(2));
  EXPECT_TRUE(sink->outcomes.empty()) << "it may follow";
  run_for(seconds(3));
  EXPECT_EQ(outcome().result, Became::unknown);
}

TEST_F(NodeOutputsTest, A_node_that_was_started_anew_has_cancelled_what_was_not_due) {
  begin_node(press());
  schedule("lamp", 1, seconds(100));
  schedule("speed", 1, milliseconds(20));
  ++device.epoch;
  run_for(seconds(3));
  ASSERT_EQ(sink->outcomes.size(), 2U);
  EXPECT_EQ(sink->outcomes[0].result, Became::cancelled);
  EXPECT_EQ(sink->outcomes[0].reason, "the device read a new map, lost or found a chip, or ended");
  EXPECT_EQ(sink->outcomes[1].result, Became::unknown);
}

TEST_F(NodeOutputsTest, Each_has_one_outcome_though_the_sink_throws) {
  begin_node(press());
  for (int i = 0; i < 3; ++i) schedule("lamp", 1, seconds(100));
  ++device.epoch;
  sink->throwing_outcomes = 1;
  EXPECT_THROW(run_for(seconds(3)), std::bad_alloc);
  engine->give_up("no memory");
  ASSERT_EQ(sink->outcomes.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(sink->outcomes[i].number, i + 1);
}

TEST_F(NodeOutputsTest, What_the_node_drove_for_good_is_restored_after_a_reconnect) {
  auto builder = press();
  builder.head().on_reconnect = OnReconnect::restore;
  begin_node(builder);
  schedule("lamp", 1, milliseconds(100));
  schedule("speed", 5, milliseconds(100), seconds(1));
  run_for(milliseconds(100));
  device.decide(1, Kind::done);
  device.decide(2, Kind::done);
  run_for(milliseconds(10));
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(seconds(3));
  EXPECT_EQ(device.count("write coil 5"), 1U);
  EXPECT_EQ(device.count("write register 2"), 0U);
}

TEST_F(NodeOutputsTest, What_the_driver_restores_goes_before_a_call_that_it_would_cancel) {
  auto builder = press();
  builder.head().on_reconnect = OnReconnect::restore;
  begin_node(builder);
  push("speed", 5);
  run_for(milliseconds(10));
  device.next_errors = {TransportFailure{"it has gone"}};
  device.refuse_connect = NotConnected{"refused"};
  run_for(milliseconds(200));
  device.refuse_connect.reset();
  device.requests.clear();
  device.during_read = [this] {  // while it is asked who it is
    push("speed", 7);
    device.during_read = nullptr;
  };
  std::future<ScheduleAnswer> asked;
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request != "write register 2" || asked.valid()) return std::nullopt;
    asked = engine->schedule(wanted("speed", 9, seconds(1)));
    return modbus::Exception::illegal_data_value;
  };
  run_for(seconds(2));
  ASSERT_TRUE(asked.valid());
  EXPECT_EQ(asked.get().text, "accepted: the device does it");
  EXPECT_EQ(speed(), 5);
  const auto scheduled = std::find(device.requests.begin(), device.requests.end(), "schedule");
  EXPECT_EQ(std::count(device.requests.begin(), scheduled, "write register 2"), 2);
}

TEST_F(NodeOutputsTest, What_was_written_since_the_node_drove_it_is_restored_and_not_that) {
  auto builder = press();
  builder.head().on_reconnect = OnReconnect::restore;
  begin_node(builder);
  schedule("lamp", 1, milliseconds(100));
  run_for(milliseconds(100));
  push("lamp", 0);
  engine->step();
  device.decide(1, Kind::done);  // told late
  run_for(milliseconds(10));
  EXPECT_EQ(outcome().result, Became::done);
  device.values[{Table::coils, 5}] = 1;
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(seconds(3));
  EXPECT_EQ(device.count("write coil 5"), 2U);
  EXPECT_EQ(lamp(), 0);
}

TEST_F(NodeOutputsTest, What_the_node_drove_before_safe_values_is_not_restored) {
  auto builder = press();
  builder.head().on_reconnect = OnReconnect::restore;
  begin_node(builder);
  schedule("lamp", 1, milliseconds(100));
  run_for(milliseconds(100));
  auto safe = engine->make_safe();
  device.decide(1, Kind::done);  // the answer to the wait tells it when the values have been chosen
  engine->step();
  EXPECT_EQ(outcome().result, Became::done);
  device.values[{Table::coils, 5}] = 1;
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(seconds(3));
  EXPECT_EQ(lamp(), 0);
}

}  // namespace
}  // namespace coupler::host
