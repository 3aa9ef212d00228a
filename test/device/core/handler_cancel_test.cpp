// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/core/scheduled_outputs.hpp"

namespace coupler::device {
namespace {

using modbus::Change;
using modbus::Reason;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Recovery = Watchdog::Recovery;

const Pdu no_such_output{0xC2, 2}, locked{0xC2, 4};

TEST_F(ScheduledOutputs, A_client_cancels_its_own_only) {
  const auto number = accept(coils(in(milliseconds(5)), 0, {1}));
  EXPECT_EQ(node_.ask(other_, cancel(number)), no_such_output);
  EXPECT_EQ(accept(cancel(number)), number);
  EXPECT_THAT(node_.outcomes.told, ElementsAre(cancelled(Reason::client, number)));
  pass(milliseconds(5));
  EXPECT_THAT(node_.lines.writes(), IsEmpty());
}

TEST_F(ScheduledOutputs, A_client_cancels_all_of_its_own_at_some_addresses_from_a_time_on) {
  const auto early = accept(coils(in(milliseconds(5)), 0, {1}));
  const auto first = accept(coils(in(milliseconds(6)), 0, {0}));
  const auto second = accept(coils(in(milliseconds(9)), 1, {0, 1}));
  const auto beside = accept(coils(in(milliseconds(9)), 3, {1}));
  const auto others = accept(other_, coils(in(milliseconds(9)), 4, {1}));
  const auto in_registers = accept(registers(in(milliseconds(9)), 0, {7, 7}));
  const Pdu request = cancel_from(in(milliseconds(6)), Table::coils, modbus::Range::of(0, 2));
  const auto reply = modbus::parse_schedule_reply(node_.ask(request));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->number, 2);
  EXPECT_EQ(reply->arrived, node_time(node_.now));
  EXPECT_THAT(node_.outcomes.told,
              ElementsAre(cancelled(Reason::client, first), cancelled(Reason::client, second)));
  pass(milliseconds(9));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 1, 1, 0));
  EXPECT_THAT(values(0, 2), ElementsAre(7, 7));
  std::vector<int> done;
  for (const Change& told : node_.outcomes.told)
    if (told.kind == Change::Kind::done) done.push_back(told.address);
  EXPECT_THAT(done, ElementsAre(early, beside, others, in_registers));
}

TEST_F(ScheduledOutputs, A_duration_that_has_begun_is_not_cancelled_with_the_others) {
  accept(coils(in(milliseconds(5)), 0, {1}, milliseconds(20)));
  pass(milliseconds(5));
  const auto waiting = accept(coils(in(milliseconds(30)), 0, {1}));
  const Pdu all = cancel_from(TimePoint::min(), Table::coils, modbus::Range::of(0, 65535));
  EXPECT_EQ(accept(all), 1);
  EXPECT_EQ(node_.outcomes.told.back(), cancelled(Reason::client, waiting));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 0, 0, 0));
  pass(milliseconds(20));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0)) << "it ends by itself";
}

TEST_F(ScheduledOutputs, To_cancel_nothing_is_no_error_and_another_epoch_is_an_exception_03) {
  accept(coils(in(milliseconds(5)), 0, {1}));
  Pdu request = cancel_from(in(milliseconds(6)), Table::coils, modbus::Range::of(0, 2));
  const auto reply = modbus::parse_schedule_reply(node_.ask(request));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->number, 0);
  request = cancel_from(in(milliseconds(5)), Table::coils, modbus::Range::of(0, 2));
  request[6] ^= 1;
  EXPECT_EQ(node_.ask(request), (Pdu{0xC2, 3}));
  EXPECT_THAT(node_.outcomes.told, IsEmpty());
}

TEST_F(ScheduledOutputs, A_plain_write_to_one_of_the_addresses_by_anyone_cancels_it) {
  const auto coil = accept(coils(in(milliseconds(5)), 0, {1, 1}));
  const auto other_coil = accept(coils(in(milliseconds(5)), 4, {1}));
  const auto level = accept(registers(in(milliseconds(5)), 0, {7, 7}));
  node_.ask(other_, pdu(5, {1, 0xFF00}));
  node_.ask(other_, pdu(22, {1, 0xFFFF, 0}));
  EXPECT_THAT(node_.outcomes.told,
              ElementsAre(cancelled(Reason::overwritten, coil), cancelled(Reason::overwritten, level)));
  pass(milliseconds(5));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 1, 0));
  EXPECT_EQ(node_.outcomes.told.back(), outcome(Change::Kind::done, Reason::none, other_coil));
}

TEST_F(ScheduledOutputs, A_write_that_is_refused_cancels_nothing) {
  accept(registers(in(milliseconds(5)), 4, {7}));
  node_.ask(pdu(6, {4, 11}));
  pass(milliseconds(5));
  EXPECT_THAT(values(4, 1), ElementsAre(7));
}

TEST_F(ScheduledOutputs, One_that_is_driven_does_not_cancel_those_for_the_same_point_later) {
  accept(coils(in(milliseconds(5)), 0, {1}));
  accept(coils(in(milliseconds(9)), 0, {0}));
  pass(milliseconds(5));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 0, 0, 0));
  pass(milliseconds(4));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST_F(ScheduledOutputs, The_end_of_the_connection_cancels_its_own) {
  const auto own = accept(coils(in(milliseconds(5)), 0, {1}));
  accept(other_, coils(in(milliseconds(5)), 1, {1}));
  node_.handler.end_session(node_.session, node_.now);
  EXPECT_THAT(node_.outcomes.told, ElementsAre(cancelled(Reason::connection, own)));
  pass(milliseconds(5));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
}

TEST_F(ScheduledOutputs, The_end_of_the_process_cancels_all) {
  const auto own = accept(coils(in(milliseconds(5)), 0, {1}));
  node_.handler.end_schedule(node_.now);
  EXPECT_THAT(node_.outcomes.told, ElementsAre(cancelled(Reason::reload, own)));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, Hardware_that_fails_is_told_and_leaves_no_trace) {
  const auto once = accept(coils(in(milliseconds(5)), 0, {1}));
  const auto lasting = accept(coils(in(milliseconds(5)), 0, {1}, milliseconds(9)));
  node_.lines.broken = true;
  pass(milliseconds(5));
  EXPECT_THAT(node_.outcomes.told, ElementsAre(outcome(Change::Kind::failed, Reason::hardware, once),
                                               outcome(Change::Kind::failed, Reason::hardware, lasting)));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, Acceptance_arms_and_feeds_the_watchdog_and_driving_does_not_feed_it) {
  accept(coils(in(timeout - milliseconds(1)), 0, {1}));
  EXPECT_EQ(node_.watchdog.left(node_.now), timeout);
  pass(timeout - milliseconds(1));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(node_.watchdog.left(node_.now), milliseconds(1)) << "its client may be dead";
  pass(milliseconds(1));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
  accept(registers(in(milliseconds(5)), 0, {1}));
  EXPECT_EQ(node_.watchdog.state(), OutputWatchdog::State::expired) << "memory is no output";
}

TEST_F(ScheduledOutputs, The_watchdog_cancels_what_has_not_begun_even_if_both_are_due) {
  const auto later = accept(coils(in(timeout + milliseconds(5)), 0, {1}));
  const auto now = accept(coils(in(timeout), 0, {1}));
  pass(timeout);
  EXPECT_THAT(node_.outcomes.told, testing::UnorderedElementsAre(cancelled(Reason::watchdog, later),
                                                                 cancelled(Reason::watchdog, now)));
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
}

TEST_F(ScheduledOutputs, After_the_watchdog_a_duration_ends_for_what_holds_and_the_others_stay_safe) {
  node_.ask(pdu(15, {0, 5}, {1, 0x01}));
  accept(coils(in(milliseconds(5)), 0, {0, 0, 1, 1, 1}, 2 * timeout));
  pass(milliseconds(5));
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 1, 1, 0)) << "coil 3 holds, coil 4 is memory";
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0)) << "coil 0 was on before";
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, The_safe_state_at_the_end_of_the_process_ends_durations_at_once) {
  accept(coils(in(milliseconds(5)), 0, {1, 1, 1, 1}, timeout));
  const auto waiting = accept(coils(in(milliseconds(9)), 4, {1}));
  pass(milliseconds(5));
  EXPECT_TRUE(node_.handler.make_safe(Reason::safe_state, node_.now));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
  EXPECT_EQ(node_.outcomes.told.back(), cancelled(Reason::safe_state, waiting));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

class LockedScheduledOutputs : public ScheduledOutputs {
 protected:
  LockedScheduledOutputs() : ScheduledOutputs(Recovery::manual) {}
};

TEST_F(LockedScheduledOutputs, Outputs_are_not_accepted_before_the_reset_and_durations_end_all_the_same) {
  accept(coils(in(milliseconds(5)), 3, {1}, 2 * timeout));
  node_.lines.outputs[3] = {1, 1};  // its safe state is what it has
  pass(milliseconds(5));
  pass(timeout);
  EXPECT_EQ(node_.ask(coils(in(milliseconds(5)), 0, {1})), locked);
  EXPECT_NE(accept(registers(in(milliseconds(5)), 0, {1})), 0) << "memory is not locked";
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
  node_.ask(pdu(6, {0xFF00, 0xAA55}));
  EXPECT_NE(accept(coils(in(milliseconds(5)), 0, {1})), 0);
}

}  // namespace
}  // namespace coupler::device
