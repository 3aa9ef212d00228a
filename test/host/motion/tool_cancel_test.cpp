// SPDX-License-Identifier: Apache-2.0
#include "test/host/motion/tool_motion_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using testing::Optional;
using How = ToolResult::How;
using P = ToolPart;

struct ToolCancelTest : ToolMotionTest {
  void use(OnCancel on_cancel) {
    Tool tool = clamp();
    tool.on_cancel = on_cancel;
    ToolMotionTest::use(tool);
  }
};

TEST_F(ToolCancelTest, A_goal_that_is_cancelled_while_it_moves_ends_at_once_and_nothing_more_is_driven) {
  use(OnCancel::stay);
  drive(ToolEnd::closed, 0);
  motion->cancel(at(120));
  EXPECT_EQ(text(), "cancelled after 120 ms");
  EXPECT_EQ(how, How::cancelled);
  EXPECT_EQ(command(), "");
}

TEST_F(ToolCancelTest, A_command_that_was_not_given_yet_is_not_given_any_more) {
  use(OnCancel::stay);
  motion->begin(ToolEnd::closed, at(0));
  motion->cancel(at(1));
  EXPECT_EQ(text(), "cancelled after 1 ms");
  EXPECT_EQ(command(), "");
}

TEST_F(ToolCancelTest, A_tool_is_where_it_was_if_nothing_was_driven) {
  ToolMotionTest::use(cup());
  drive(ToolEnd::closed, 0);
  motion->step(at(300));
  EXPECT_EQ(text(), "closed after 300 ms, its travel time");
  motion->begin(ToolEnd::open, at(400));
  motion->cancel(at(401));
  EXPECT_EQ(state(), ToolState::closed);
  motion->begin(ToolEnd::open, at(500));
  command();
  motion->cancel(at(501));
  acknowledge(502);
  EXPECT_EQ(state(), ToolState::unknown);
}

TEST_F(ToolCancelTest, A_command_on_its_way_is_acknowledged_before_the_goal_ends) {
  use(OnCancel::stay);
  motion->begin(ToolEnd::closed, at(0));
  EXPECT_EQ(command(), "open off");
  motion->cancel(at(1));
  EXPECT_EQ(text(), "");
  acknowledge(5);
  EXPECT_EQ(text(), "cancelled after 1 ms");
  EXPECT_EQ(how, How::cancelled);
  EXPECT_EQ(command(), "") << "the output is not switched on";
}

TEST_F(ToolCancelTest, A_command_on_its_way_that_fails_aborts_the_goal) {
  use(OnCancel::stay);
  motion->begin(ToolEnd::closed, at(0));
  command();
  motion->cancel(at(1));
  motion->on_written(number, "no reply in time", at(5));
  EXPECT_EQ(text(), "valve_open could not be switched off: no reply in time");
  EXPECT_EQ(how, How::aborted);
}

TEST_F(ToolCancelTest,
       On_cancel_moves_the_tool_to_that_end_and_the_goal_ends_once_the_output_is_acknowledged) {
  use(OnCancel::open);
  drive(ToolEnd::closed, 0);
  motion->cancel(at(100));
  EXPECT_EQ(text(), "");
  EXPECT_EQ(command(), "close off");
  acknowledge(105);
  EXPECT_EQ(text(), "");
  EXPECT_EQ(command(), "open on");
  acknowledge(110);
  EXPECT_EQ(text(), "cancelled after 100 ms");
  EXPECT_EQ(how, How::cancelled);
  EXPECT_EQ(state(), ToolState::opening);
  see(300, P::closed, false);
  see(310, P::opened, true);
  EXPECT_EQ(text(), "") << "a goal has one result";
  EXPECT_EQ(state(), ToolState::open);
  EXPECT_EQ(motion->status().reason, "open after 200 ms");
}

TEST_F(ToolCancelTest, A_goal_that_moves_to_the_end_of_on_cancel_goes_on_and_ends_as_cancelled) {
  use(OnCancel::close);
  motion->begin(ToolEnd::closed, at(0));
  motion->cancel(at(1));
  EXPECT_EQ(command(), "open off");
  acknowledge(5);
  EXPECT_EQ(text(), "");
  EXPECT_EQ(command(), "close on");
  acknowledge(10);
  EXPECT_EQ(text(), "cancelled after 1 ms");
  drive(ToolEnd::closed, 20);
  motion->cancel(at(30));
  EXPECT_EQ(text(), "cancelled after 10 ms");
  EXPECT_EQ(state(), ToolState::closing) << "it goes on";
}

TEST_F(ToolCancelTest, Losing_the_device_while_a_cancel_is_carried_out_aborts_the_goal) {
  use(OnCancel::open);
  drive(ToolEnd::closed, 0);
  motion->cancel(at(100));
  command();
  motion->go_offline(at(120));
  EXPECT_EQ(text(), "the connection to the device was lost after 20 ms");
  EXPECT_EQ(how, How::aborted);
}

TEST_F(ToolCancelTest, A_newer_goal_replaces_one_that_is_being_cancelled) {
  use(OnCancel::open);
  drive(ToolEnd::closed, 0);
  motion->cancel(at(100));
  motion->begin(ToolEnd::closed, at(101));
  EXPECT_EQ(text(), "replaced by a newer goal after 1 ms");
  EXPECT_EQ(how, How::replaced);
  motion->cancel(at(102));
  while (!command().empty()) acknowledge(110);
  EXPECT_EQ(text(), "cancelled after 1 ms");
  motion->begin(ToolEnd::closed, at(120));
  EXPECT_EQ(text(), "") << "there was no goal, though it moved";
}

TEST_F(ToolCancelTest, A_goal_that_is_replaced_before_its_output_was_acknowledged_ends_after_0_ms) {
  drive(ToolEnd::closed, 100);
  motion->begin(ToolEnd::open, at(97));
  EXPECT_EQ(text(), "replaced by a newer goal after 0 ms");
}

TEST_F(ToolCancelTest, A_goal_that_is_at_its_end_cannot_be_cancelled) {
  Tool tool = clamp();
  tool.hold = false;
  tool.on_cancel = OnCancel::open;
  ToolMotionTest::use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(200, P::closed, true);
  motion->cancel(at(201));
  EXPECT_EQ(command(), "close off");
  acknowledge(205);
  EXPECT_EQ(text(), "closed after 200 ms");
  motion->cancel(at(300));
  EXPECT_EQ(command(), "");
  EXPECT_EQ(text(), "");
}

struct ToolPositionTest : ToolMotionTest {
  ToolPositionTest() {
    tool.positions = {0.04, 0.01};
    use(tool);
  }
  Tool tool = clamp();
};

TEST_F(ToolPositionTest, Its_position_is_that_of_an_end_or_the_middle_and_is_not_always_known) {
  see(0, P::opened, false);
  see(0, P::closed, false);
  EXPECT_THAT(motion->position(), Optional(0.025)) << "it is at neither end";
  see(0, P::opened, true);
  EXPECT_THAT(motion->position(), Optional(0.04));
  see(0, P::closed, true);
  EXPECT_EQ(motion->position(), std::nullopt) << "both ends cannot be";
  see(1, P::closed, false);
  drive(ToolEnd::closed, 10);
  EXPECT_THAT(motion->position(), Optional(0.025));
  see(20, P::opened, false);
  see(200, P::closed, true);
  EXPECT_THAT(motion->position(), Optional(0.01));
}

TEST_F(ToolPositionTest, A_position_that_no_input_shows_is_known_since_the_tool_reached_it) {
  EXPECT_EQ(motion->there_since(), Time::min());
  see(0, P::opened, true);
  EXPECT_EQ(motion->there_since(), Time::min());
  drive(ToolEnd::closed, 10);
  EXPECT_EQ(motion->there_since(), at(10));
  motion->step(at(810));
  EXPECT_EQ(state(), ToolState::stuck);
  EXPECT_EQ(motion->there_since(), at(810));
}

TEST_F(ToolPositionTest, A_tool_that_is_stuck_is_in_the_middle_as_far_as_anybody_knows) {
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(10, P::closed, false);
  motion->step(at(800));
  EXPECT_EQ(text(), "stuck: neither end after 800 ms (valve_close is on)");
  EXPECT_EQ(how, How::stuck);
  EXPECT_THAT(motion->position(), Optional(0.025));
}

TEST_F(ToolPositionTest, A_tool_that_holds_a_part_is_closed_unless_its_input_says_that_it_is_not) {
  tool.holds = "part_present";
  use(tool);
  drive(ToolEnd::closed, 0);
  see(10, P::opened, false);
  see(10, P::closed, false);
  see(180, P::holds, true);
  EXPECT_EQ(text(), "holds a part after 180 ms");
  EXPECT_THAT(motion->position(), Optional(0.025));
  see(190, P::closed, true);
  EXPECT_THAT(motion->position(), Optional(0.01));
}

}  // namespace
}  // namespace coupler::host
