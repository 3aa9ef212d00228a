// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/map/identity.hpp"
#include "test/device/core/scheduled_outputs.hpp"

namespace coupler::device {
namespace {

using modbus::Change;
using modbus::Range;
using modbus::Reason;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

const Pdu no_place{0xC2, 6}, unplugged{0xC2, 4}, bad_value{0xC2, 3}, bad_address{0xC2, 2};

TEST_F(ScheduledOutputs, It_is_driven_in_one_step_when_it_is_due_and_not_before) {
  const auto number = accept(coils(in(milliseconds(20)), 0, {1, 0, 1}));
  ASSERT_NE(number, 0);
  EXPECT_EQ(node_.handler.time_until_due(node_.now), milliseconds(20));
  pass(milliseconds(19));
  EXPECT_THAT(node_.lines.writes(), IsEmpty());
  EXPECT_THAT(node_.outcomes.told, IsEmpty());
  pass(milliseconds(1));
  EXPECT_THAT(node_.lines.writes(), ElementsAre(testing::Pair(Range::of(0, 3), ElementsAre(1, 0, 1))));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 1, 0, 0, 0));
  EXPECT_THAT(node_.outcomes.told, ElementsAre(outcome(Change::Kind::done, Reason::none, number)));
}

TEST_F(ScheduledOutputs, What_is_due_is_driven_before_a_request_that_comes_later) {
  accept(coils(in(milliseconds(5)), 4, {1}));
  node_.now += milliseconds(5);
  EXPECT_THAT(node_.ask(pdu(1, {4, 1})), ElementsAre(1, 1, 1));
}

TEST_F(ScheduledOutputs, The_reply_has_the_number_and_the_times) {
  const auto reply = modbus::parse_schedule_reply(node_.ask(coils(in(milliseconds(5)), 0, {1})));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->arrived, node_time(node_.now));
  EXPECT_EQ(reply->replied, node_time(node_.now));
}

TEST_F(ScheduledOutputs, Another_epoch_and_times_that_are_too_far_are_03) {
  Pdu request = coils(in(milliseconds(5)), 0, {1});
  request[6] ^= 1;
  EXPECT_EQ(node_.ask(request), bad_value);
  Pdu cancels = cancel(accept(coils(in(milliseconds(5)), 0, {1})));
  cancels[6] ^= 1;
  EXPECT_EQ(node_.ask(cancels), bad_value);
  const auto tick = TimePoint::duration(1);
  EXPECT_EQ(node_.ask(coils(in(-milliseconds(1)) - tick, 0, {1})), bad_value);
  EXPECT_EQ(node_.ask(coils(in(std::chrono::hours(1)) + tick, 0, {1})), bad_value);
  EXPECT_EQ(node_.ask(coils(TimePoint::max(), 0, {1})), bad_value);
  EXPECT_EQ(node_.ask(coils(TimePoint::min(), 0, {1})), bad_value);
  EXPECT_NE(accept(coils(in(-milliseconds(1)), 0, {1})), 0);
  EXPECT_NE(accept(coils(in(std::chrono::hours(1)), 0, {1})), 0);
}

TEST_F(ScheduledOutputs, It_is_checked_whole_when_it_is_accepted) {
  const TimePoint due = in(milliseconds(5));
  EXPECT_EQ(node_.ask(coils(due, 5, {1, 1})), bad_address) << "coil 6 is not mapped";
  EXPECT_EQ(node_.ask(registers(due, 4, {1, 1})), bad_address) << "register 5 is not writable";
  EXPECT_EQ(node_.ask(registers(due, 3, {1})), bad_address) << "half of an analogue value";
  EXPECT_EQ(node_.ask(registers(due, 4, {11})), bad_value) << "above the largest that the map allows";
  EXPECT_EQ(node_.ask(registers(due, 2, {0x42C9, 0})), bad_value) << "100.5 % of a PWM";
  node_.channels.gone.insert(2);
  EXPECT_EQ(node_.ask(registers(due, 2, {0x4248, 0})), unplugged) << "its chip is unplugged";
  node_.lines.unplugged = true;
  EXPECT_EQ(node_.ask(coils(due, 0, {1})), unplugged);
  EXPECT_THAT(node_.channels.driven, IsEmpty());
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, The_65th_finds_no_place) {
  for (int i = 0; i < 64; ++i) ASSERT_NE(accept(coils(in(milliseconds(5)), 0, {1})), 0);
  EXPECT_EQ(node_.ask(coils(in(milliseconds(5)), 0, {1})), no_place);
  EXPECT_EQ(node_.statistics.exceptions, 1U);
  pass(milliseconds(5));
  EXPECT_NE(accept(coils(in(milliseconds(5)), 0, {1})), 0);
}

TEST_F(ScheduledOutputs, After_its_duration_the_outputs_are_as_they_were) {
  node_.ask(pdu(15, {0, 3}, {1, 0x01}));
  accept(coils(in(milliseconds(5)), 0, {0, 1, 1}, milliseconds(50)));
  accept(registers(in(milliseconds(5)), 2, {0x4248, 0}, milliseconds(50)));
  pass(milliseconds(5));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0));
  EXPECT_EQ(node_.channels.outputs[2], 50);
  pass(milliseconds(49));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0));
  pass(milliseconds(1));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(node_.lines.outputs[1].level, 0);
  EXPECT_EQ(node_.channels.outputs[2], 0);
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, A_duration_ends_though_its_client_is_gone_and_cannot_be_cancelled) {
  const auto number = accept(coils(in(milliseconds(5)), 4, {1}, milliseconds(50)));
  pass(milliseconds(5));
  EXPECT_EQ(node_.ask(cancel(number)), bad_address);
  node_.handler.end_session(node_.session, node_.now);
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_THAT(node_.outcomes.told, testing::SizeIs(1)) << "it was done, and nothing else";
}

TEST_F(ScheduledOutputs, Durations_that_overlap_end_with_what_was_before_the_first) {
  accept(coils(in(milliseconds(10)), 0, {1, 1}, milliseconds(100)));
  accept(coils(in(milliseconds(50)), 1, {1, 1}, milliseconds(100)));
  pass(milliseconds(10));
  pass(milliseconds(40));
  EXPECT_THAT(levels(), ElementsAre(1, 1, 1, 0, 0, 0));
  pass(milliseconds(60));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0)) << "coil 1 is still in its second duration";
  pass(milliseconds(40));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST_F(ScheduledOutputs, An_edge_that_is_seen_during_a_duration_stays_latched) {
  accept(coils(in(milliseconds(5)), 4, {1, 1}, milliseconds(50)));
  pass(milliseconds(5));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 1, 0)) << "a client cannot set a latch";
  node_.lines.edges = {{0, Edges{1, 0, 0}}};
  node_.ask(pdu(1, {0, 1}));
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 1));
}

TEST_F(ScheduledOutputs, Times_are_those_at_which_it_was_done) {
  const milliseconds takes(3);
  node_.lines.on_drive = [&] { node_.now += takes; };
  const TimePoint due = in(milliseconds(20));
  const auto number = accept(coils(due, 0, {1}, milliseconds(50)));
  node_.now = due;
  node_.handler.tick(due);
  ASSERT_THAT(node_.outcomes.told, ElementsAre(outcome(Change::Kind::done, Reason::none, number)));
  EXPECT_EQ(node_.outcomes.told[0].at, node_time(due + takes));
  EXPECT_EQ(node_.handler.next_scheduled(), due + takes + milliseconds(50))
      << "the duration counts from there";
  const auto* told = node_.changes.ring().next_after(0);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->change.at, node_time(due + takes)) << "of the coil";
}

TEST_F(ScheduledOutputs, The_identity_area_says_that_it_is_answered) {
  const Pdu reply = node_.ask(pdu(4, {0xFF00 + identity::at_functions, 1}));
  EXPECT_THAT(reply, ElementsAre(4, 2, 0, 3)) << "65 and 66";
}

}  // namespace
}  // namespace coupler::device
