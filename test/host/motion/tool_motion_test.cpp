// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/tool_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/host/motion/tool_motion_test.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using How = ToolResult::How;
using P = ToolPart;

TEST_F(ToolMotionTest, An_output_goes_on_when_the_other_one_is_acknowledged_to_be_off) {
  motion->begin(ToolEnd::closed, at(0));
  EXPECT_EQ(command(), "open off");
  EXPECT_EQ(command(), "");
  acknowledge(5);
  EXPECT_EQ(command(), "close on");
  EXPECT_EQ(state(), ToolState::closing);
}

TEST_F(ToolMotionTest, An_output_that_cannot_be_switched_off_keeps_the_other_one_off) {
  motion->begin(ToolEnd::closed, at(0));
  EXPECT_EQ(command(), "open off");
  motion->on_written(number, "exception 04 (server device failure)", at(5));
  EXPECT_EQ(command(), "");
  EXPECT_EQ(text(), "valve_open could not be switched off: exception 04 (server device failure)");
  EXPECT_EQ(how, How::aborted);
}

TEST_F(ToolMotionTest, The_input_of_the_end_ends_the_goal_once_that_of_the_other_end_is_off) {
  drive(ToolEnd::closed, 100);
  see(110, P::opened, true);
  see(300, P::closed, true);
  EXPECT_EQ(text(), "");
  see(312, P::opened, false);
  EXPECT_EQ(text(), "closed after 212 ms");
  EXPECT_EQ(how, How::reached);
  EXPECT_EQ(state(), ToolState::closed);
  EXPECT_EQ(motion->status().reason, "closed after 212 ms");
}

TEST_F(ToolMotionTest, An_old_value_ends_nothing_and_a_new_one_is_asked_for) {
  see(50, P::closed, true);
  see(50, P::opened, false);
  motion->begin(ToolEnd::closed, at(100));
  while (!command().empty()) acknowledge(100);
  EXPECT_EQ(text(), "");
  motion->step(at(100));
  EXPECT_THAT(motion->take_asked(), ElementsAre(P::closed, P::opened));
  motion->see(P::closed, true, {at(101), milliseconds(2)}, at(104));  // perhaps from before
  motion->see(P::opened, false, {at(103), milliseconds(1)}, at(104));
  EXPECT_EQ(text(), "");
  see(110, P::closed, true);
  EXPECT_EQ(text(), "closed after 10 ms");
}

TEST_F(ToolMotionTest, An_input_counts_when_it_has_settled) {
  Tool tool = clamp();
  tool.settle = milliseconds(30);
  use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(200, P::closed, true);
  see(210, P::closed, false);  // it bounces
  see(220, P::closed, true);
  EXPECT_EQ(motion->step(at(225)), at(250));
  EXPECT_THAT(motion->take_asked(), IsEmpty());
  EXPECT_EQ(motion->step(at(250)), at(800));
  EXPECT_THAT(motion->take_asked(), ElementsAre(P::closed)) << "a node that announces changes says no more";
  see(251, P::closed, true);
  EXPECT_EQ(text(), "closed after 251 ms");
}

TEST_F(ToolMotionTest, Where_no_input_says_so_the_travel_time_does) {
  use(cup());
  drive(ToolEnd::closed, 0);
  EXPECT_EQ(motion->step(at(299)), at(300));
  EXPECT_EQ(text(), "");
  motion->step(at(300));
  EXPECT_EQ(text(), "closed after 300 ms, its travel time");
  EXPECT_EQ(state(), ToolState::closed);
}

TEST_F(ToolMotionTest, A_tool_with_one_output_moves_back_when_that_is_off) {
  use(cup());
  motion->begin(ToolEnd::open, at(0));
  EXPECT_EQ(command(), "close off");
  acknowledge(1);
  EXPECT_EQ(command(), "");
  motion->step(at(301));
  EXPECT_EQ(text(), "open after 300 ms, its travel time");
}

TEST_F(ToolMotionTest, A_part_that_is_held_ends_the_goal) {
  Tool tool = clamp();
  tool.holds = "part_present";
  use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::holds, true);
  see(10, P::opened, true);
  EXPECT_EQ(text(), "") << "it is still open, whatever stands before the sensor";
  see(180, P::opened, false);
  EXPECT_EQ(text(), "holds a part after 180 ms");
  EXPECT_EQ(how, How::holds);
  EXPECT_EQ(state(), ToolState::holding);
}

TEST_F(ToolMotionTest, A_part_that_is_lost_is_seen) {
  Tool tool = cup();
  tool.holds = "vacuum_reached";
  use(tool);
  drive(ToolEnd::closed, 0);
  see(180, P::holds, true);
  EXPECT_EQ(text(), "holds a part after 180 ms");
  see(900, P::holds, false);
  EXPECT_EQ(state(), ToolState::closed);
}

TEST_F(ToolMotionTest, Closed_without_a_part_fails_unless_that_is_ok) {
  Tool tool = clamp();
  tool.holds = "part_present";
  for (const OnEmpty empty : {OnEmpty::abort, OnEmpty::ok}) {
    tool.empty = empty;
    use(tool);
    drive(ToolEnd::closed, 0);
    see(10, P::opened, false);
    see(200, P::closed, true);
    EXPECT_EQ(text(), "") << "nothing is known of the part";
    see(212, P::holds, false);
    EXPECT_EQ(text(), empty == OnEmpty::ok ? "closed after 212 ms"
                                           : "closed without a part after 212 ms (valve_close is on)");
    EXPECT_EQ(how, empty == OnEmpty::ok ? How::reached : How::stuck);
    EXPECT_EQ(state(), ToolState::closed);
  }
}

TEST_F(ToolMotionTest, Neither_end_in_time_is_stuck) {
  drive(ToolEnd::closed, 0);
  see(10, P::closed, false);
  see(10, P::opened, false);
  EXPECT_EQ(motion->step(at(799)), at(800));
  motion->step(at(800));
  EXPECT_EQ(text(), "stuck: neither end after 800 ms (valve_close is on)");
  EXPECT_EQ(state(), ToolState::stuck);
  see(900, P::closed, false);
  EXPECT_EQ(state(), ToolState::stuck);
  see(1000, P::closed, true);
  EXPECT_EQ(state(), ToolState::closed) << "somebody has freed it";
}

TEST_F(ToolMotionTest, What_does_not_leave_its_end_is_stuck_there) {
  drive(ToolEnd::closed, 0);
  see(10, P::closed, false);
  see(10, P::opened, true);
  motion->step(at(800));
  EXPECT_EQ(text(), "stuck: sensor_open is still on after 800 ms (valve_close is on)");
  see(900, P::opened, true);
  EXPECT_EQ(state(), ToolState::stuck);
}

TEST_F(ToolMotionTest, An_input_without_a_value_is_named) {
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  motion->step(at(800));
  EXPECT_EQ(text(), "stuck: no new value of sensor_closed after 800 ms (valve_close is on)");
}

TEST_F(ToolMotionTest, Inputs_of_both_ends_contradict_each_other) {
  drive(ToolEnd::closed, 0);
  see(10, P::opened, true);
  see(200, P::closed, true);
  motion->step(at(800));
  EXPECT_EQ(text(), "sensor_closed and sensor_open are both on after 800 ms (valve_close is on)");
  EXPECT_EQ(state(), ToolState::contradictory);
  see(900, P::opened, false);
  EXPECT_EQ(state(), ToolState::closed);
}

TEST_F(ToolMotionTest, An_output_that_is_not_held_goes_off_at_the_end) {
  Tool tool = clamp();
  tool.hold = false;
  use(tool);
  motion->begin(ToolEnd::closed, at(0));
  EXPECT_EQ(command(), "open off");
  acknowledge(0);
  EXPECT_EQ(command(), "close on");
  acknowledge(0);
  see(10, P::opened, false);
  see(200, P::closed, true);
  EXPECT_EQ(text(), "");
  EXPECT_EQ(command(), "close off");
  acknowledge(205);
  EXPECT_EQ(text(), "closed after 200 ms");
  see(300, P::close, false);
  EXPECT_EQ(state(), ToolState::closed);
}

TEST_F(ToolMotionTest, A_newer_goal_aborts_the_one_before) {
  drive(ToolEnd::closed, 0);
  motion->begin(ToolEnd::open, at(120));
  EXPECT_EQ(text(), "replaced by a newer goal after 120 ms");
  EXPECT_EQ(how, How::replaced);
  EXPECT_EQ(command(), "close off");
  acknowledge(125);
  EXPECT_EQ(command(), "open on");
  EXPECT_EQ(state(), ToolState::opening);
}

TEST_F(ToolMotionTest, The_result_of_a_command_of_an_earlier_goal_does_not_count) {
  motion->begin(ToolEnd::closed, at(0));
  command();
  acknowledge(1);
  EXPECT_EQ(command(), "close on");
  const std::uint64_t earlier = number;
  motion->begin(ToolEnd::open, at(2));
  EXPECT_EQ(command(), "close off");
  motion->on_written(earlier, {}, at(3));
  EXPECT_EQ(command(), "") << "that the output is on is no reason to switch on the other one";
  acknowledge(4);
  EXPECT_EQ(command(), "open on");
}

TEST_F(ToolMotionTest, A_write_by_another_program_aborts_the_goal) {
  drive(ToolEnd::closed, 100);
  motion->see(P::close, false, {at(101), milliseconds(2)}, at(105));  // perhaps from before it was driven
  see(110, P::close, true);
  EXPECT_EQ(text(), "");
  see(120, P::open, true);
  EXPECT_EQ(text(), "valve_open was switched on by something else after 20 ms");
}

TEST_F(ToolMotionTest, A_device_that_is_offline_makes_it_unknown) {
  use(cup());
  drive(ToolEnd::closed, 0);
  motion->step(at(300));
  EXPECT_EQ(text(), "closed after 300 ms, its travel time");
  drive(ToolEnd::open, 400);
  motion->go_offline(at(500));
  EXPECT_EQ(text(), "the connection to the device was lost after 100 ms");
  EXPECT_EQ(state(), ToolState::unknown);
}

TEST_F(ToolMotionTest, What_an_earlier_goal_has_driven_does_not_count) {
  drive(ToolEnd::closed, 0);
  motion->go_offline(at(100));
  text();
  motion->begin(ToolEnd::closed, at(200));
  see(201, P::close, false);  // the node's watchdog has switched it off
  EXPECT_EQ(text(), "");
}

TEST_F(ToolMotionTest, The_reason_of_a_goal_stays_as_long_as_the_state) {
  use(cup());
  motion->begin(ToolEnd::closed, at(0));
  command();
  motion->on_written(number, "exception 02 (illegal data address)", at(1));
  motion->step(at(2));
  EXPECT_EQ(motion->status().reason, "vacuum could not be switched on: exception 02 (illegal data address)");
  see(5, P::close, false);
  EXPECT_EQ(motion->status().reason, "vacuum could not be switched on: exception 02 (illegal data address)");
}

TEST_F(ToolMotionTest, An_output_that_is_found_otherwise_makes_its_state_unknown) {
  use(cup());
  see(0, P::close, false);
  drive(ToolEnd::closed, 10);
  motion->step(at(310));
  EXPECT_EQ(state(), ToolState::closed);
  motion->take_status();
  motion->take_results();
  EXPECT_TRUE(motion->see(P::close, false, {at(400), {}}, at(400))) << "off, and never seen on";
  EXPECT_EQ(state(), ToolState::unknown);
}

TEST_F(ToolMotionTest, A_change_that_may_have_been_before_the_motion_is_looked_at_again) {
  drive(ToolEnd::closed, 100);
  see(110, P::opened, false);
  motion->see(P::closed, true, {at(150), milliseconds(900)}, at(151));
  EXPECT_EQ(text(), "");
  motion->step(at(151));
  EXPECT_THAT(motion->take_asked(), ElementsAre(P::closed));
  motion->step(at(152));
  EXPECT_THAT(motion->take_asked(), IsEmpty());
  see(160, P::closed, true);
  EXPECT_EQ(text(), "closed after 60 ms");
}

TEST_F(ToolMotionTest, What_is_said_of_a_tool_that_is_stuck_does_not_speak_of_what_does_not_matter) {
  Tool tool = clamp();
  tool.holds = "part_present";
  use(tool);
  drive(ToolEnd::open, 0);
  for (const P part : {P::closed, P::opened}) see(10, part, false);
  see(10, P::holds, true);
  motion->step(at(800));
  EXPECT_EQ(text(), "stuck: neither end after 800 ms (valve_open is on)");
}

TEST_F(ToolMotionTest, After_it_was_disturbed_nothing_more_is_driven) {
  Tool tool = clamp();
  tool.hold = false;
  use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(20, P::closed, true);
  motion->disturb("safe values were requested", at(20));
  EXPECT_EQ(text(), "safe values were requested");
  EXPECT_EQ(command(), "");
}

TEST_F(ToolMotionTest, A_part_may_be_seen_by_the_reading_that_sees_the_end) {
  Tool tool = clamp();
  tool.holds = "part_present";
  use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(10, P::holds, false);
  see(200, P::closed, true);
  EXPECT_EQ(text(), "") << "the part comes next";
  see(200, P::holds, true);
  EXPECT_EQ(text(), "holds a part after 200 ms");
}

TEST_F(ToolMotionTest, A_part_may_be_seen_until_the_travel_time_has_passed) {
  Tool tool = cup();
  tool.holds = "vacuum_reached";
  use(tool);
  drive(ToolEnd::closed, 0);
  see(5, P::holds, false);
  EXPECT_EQ(motion->step(at(10)), at(300));
  motion->step(at(300));
  EXPECT_EQ(text(), "") << "nobody knows yet";
  EXPECT_THAT(motion->take_asked(), ElementsAre(P::holds));
  see(302, P::holds, true);
  EXPECT_EQ(text(), "holds a part after 302 ms");
}

TEST_F(ToolMotionTest, A_tool_that_was_stuck_is_so_until_its_inputs_say_that_it_is_there) {
  Tool tool = cup();
  tool.holds = "vacuum_reached";
  tool.settle = milliseconds(30);
  tool.timeout = milliseconds(320);
  use(tool);
  drive(ToolEnd::closed, 0);
  see(310, P::holds, true);
  motion->step(at(320));
  EXPECT_EQ(text(), "stuck: vacuum_reached has not settled after 320 ms (vacuum is on)");
  EXPECT_EQ(state(), ToolState::stuck);
  see(400, P::holds, true);
  EXPECT_EQ(state(), ToolState::holding);
}

TEST_F(ToolMotionTest, Before_the_first_goal_its_inputs_say_where_it_is) {
  EXPECT_EQ(motion->status().reason, "");
  see(0, P::closed, false);
  EXPECT_EQ(state(), ToolState::unknown);
  EXPECT_EQ(motion->status().reason, "no value of sensor_open");
  see(0, P::opened, false);
  EXPECT_EQ(motion->status().reason, "no input says that it is at an end");
  see(5, P::opened, true);
  EXPECT_EQ(state(), ToolState::open);
  EXPECT_EQ(motion->status().since, at(5));
  EXPECT_EQ(command(), "") << "nothing is driven";
}

TEST_F(ToolMotionTest, A_status_is_given_once) {
  EXPECT_TRUE(motion->take_status());
  EXPECT_FALSE(motion->take_status());
  see(0, P::opened, true);
  EXPECT_EQ(motion->take_status()->state, ToolState::open);
  see(1, P::opened, true);
  EXPECT_FALSE(motion->take_status());
}

}  // namespace
}  // namespace coupler::host
