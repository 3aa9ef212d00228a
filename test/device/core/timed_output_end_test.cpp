// SPDX-License-Identifier: Apache-2.0
// Durations whose end the hardware refuses, as clients see it.
#include <gmock/gmock.h>

#include "test/device/core/scheduled_outputs.hpp"

namespace coupler::device {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using Reason = modbus::Reason;

constexpr milliseconds retry = TimedOutputEnd::retry_period;

TEST_F(ScheduledOutputs, An_end_that_the_hardware_refuses_is_tried_until_it_is_done) {
  accept(coils(in(milliseconds(5)), 0, {1}, milliseconds(50)));
  pass(milliseconds(5));
  node_.lines.broken = true;
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0, 0, 0, 0)) << "the image shows how the line is driven";
  node_.lines.broken = false;
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST_F(ScheduledOutputs, An_output_that_cannot_go_back_keeps_no_other_from_it) {
  accept(coils(in(milliseconds(5)), 0, {1, 1, 1, 1, 1}, milliseconds(50)));
  pass(milliseconds(5));
  node_.lines.stuck = 1;
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), in(retry));
  node_.lines.stuck.reset();
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, What_went_back_or_was_written_since_is_not_brought_back_with_the_rest) {
  accept(coils(in(milliseconds(5)), 0, {1, 1, 1}, milliseconds(50)));
  pass(milliseconds(5));
  node_.lines.stuck = 1;
  pass(milliseconds(50));
  node_.ask(pdu(5, {2, 0xFF00}));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0));
  node_.lines.stuck.reset();
  node_.ask(pdu(5, {1, 0xFF00}));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0)) << "the end is over, and then its client wrote";
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, A_duration_that_begins_while_another_is_overdue_ends_with_the_value_from_before) {
  accept(coils(in(milliseconds(5)), 0, {1, 0, 1}, milliseconds(50)));
  pass(milliseconds(5));
  node_.lines.stuck = 0;
  pass(milliseconds(50));
  node_.lines.stuck.reset();
  accept(coils(in(milliseconds(5)), 0, {1, 0, 1}, 3 * retry));
  pass(milliseconds(5));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(1, 0, 1, 0, 0, 0));
  pass(2 * retry);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, A_write_stays_while_two_durations_that_overlap_cannot_end) {
  accept(coils(in(milliseconds(5)), 0, {1, 0, 1}, milliseconds(50)));
  accept(coils(in(milliseconds(6)), 2, {0, 1}, milliseconds(60)));
  pass(milliseconds(6));
  node_.lines.broken = true;
  pass(milliseconds(60));
  node_.lines.broken = false;
  node_.lines.stuck = 0;
  node_.ask(pdu(5, {2, 0xFF00}));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(1, 0, 1, 0, 0, 0));
}

TEST_F(ScheduledOutputs, A_write_to_what_went_to_its_safe_state_late_stays_while_another_output_is_stuck) {
  accept(coils(in(milliseconds(5)), 0, {1, 0, 1}, 2 * timeout));
  pass(milliseconds(5));
  node_.lines.stuck = 0;
  pass(timeout);
  node_.ask(pdu(5, {3, 0xFF00}));
  pass(timeout);
  node_.ask(pdu(5, {2, 0xFF00}));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(1, 1, 1, 1, 0, 0));
}

TEST_F(ScheduledOutputs,
       A_channel_that_cannot_go_back_is_tried_again_and_one_that_is_unplugged_comes_back_so) {
  const auto valve = [](int high) { return std::vector<std::uint16_t>{static_cast<std::uint16_t>(high), 0}; };
  accept(registers(in(milliseconds(5)), 2, valve(0x41A0), milliseconds(50)));  // 20 %
  pass(milliseconds(5));
  EXPECT_EQ(node_.channels.outputs[2], 20);
  node_.channels.broken = {2};
  pass(milliseconds(50));
  EXPECT_THAT(values(2, 2), ElementsAre(0x41A0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), in(retry));
  node_.channels.broken.clear();
  node_.channels.unplugged = {2};
  pass(retry);
  EXPECT_THAT(values(2, 2), ElementsAre(0, 0)) << "what it is driven to when it is plugged in again";
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, What_the_watchdog_could_not_make_safe_is_safe_at_the_end_of_its_duration) {
  node_.ask(pdu(5, {0, 0xFF00}));
  accept(coils(in(milliseconds(5)), 0, {1, 0, 1}, 4 * timeout));
  pass(milliseconds(5));
  node_.lines.stuck = 0;
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(1, 1, 0, 0, 0, 0)) << "one that cannot be driven";
  node_.lines.stuck.reset();
  for (int i = 0; i < 8; ++i) {  // a client that writes again: what has expired is forgotten
    node_.ask(pdu(5, {3, 0xFF00}));
    pass(timeout / 2);
  }
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 1, 0, 0)) << "not the level from before, which was on";
}

TEST_F(ScheduledOutputs, An_end_that_is_tried_again_brings_nothing_out_of_its_safe_state) {
  for (const int coil : {0, 2}) node_.ask(pdu(5, {coil, 0xFF00}));
  accept(coils(in(milliseconds(5)), 0, {0, 1, 0}, milliseconds(50)));
  pass(milliseconds(5));
  node_.lines.stuck = 0;
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 1, 0, 0, 0));
  pass(timeout);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0)) << "the watchdog expired";
  node_.ask(pdu(5, {2, 0xFF00}));
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0)) << "nor does it undo a later write";
  node_.ask(pdu(5, {2, 0}));
  node_.lines.stuck.reset();
  pass(retry);
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0, 0, 0, 0));
  EXPECT_EQ(node_.handler.next_scheduled(), TimePoint::max());
}

TEST_F(ScheduledOutputs, A_process_that_dies_on_the_way_to_the_safe_state_leaves_it_to_the_next_one) {
  node_.ask(pdu(5, {2, 0xFF00}));
  accept(coils(in(milliseconds(5)), 0, {1, 0, 0}, 4 * timeout));
  pass(milliseconds(5));
  std::vector<ScheduledOutput> left;  // what is in the shared memory when it dies
  node_.lines.on_safe = [&] { left = node_.scheduled; };
  pass(timeout);
  NodeUnderTest next(node_.owner);
  next.lines.outputs = node_.lines.outputs;
  next.scheduled = left;
  OutputSchedule schedule(next.scheduled);
  Hardware hardware(next.lines);
  std::vector<std::uint16_t> space(modbus::max_scheduled_bits);
  EXPECT_TRUE(TimedOutputEnd(next.map, next.image, hardware, schedule, space).of_all(in(4 * timeout)));
  EXPECT_EQ(next.lines.outputs[2].level, 0) << "not on, as it was before";
}

TEST_F(ScheduledOutputs,
       An_end_of_the_process_that_leaves_an_output_on_says_so_and_the_next_one_tries_again) {
  accept(coils(in(milliseconds(5)), 0, {1, 1, 1}, timeout));
  pass(milliseconds(5));
  node_.lines.stuck = 2;
  EXPECT_FALSE(node_.handler.make_safe(Reason::safe_state, node_.now));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1, 0, 0, 0));
  OutputSchedule next_process(node_.scheduled);
  EXPECT_EQ(next_process.earliest(), in(retry));
}

}  // namespace
}  // namespace coupler::device
