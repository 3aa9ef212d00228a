// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectory_motion.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "test/host/motion/sample_joints.hpp"

namespace coupler::host {
namespace {

using TrajectoryEnd = TrajectoryResult::How;
using Result = ScheduledOutcome::Result;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct TrajectoryMotionTest : SampleJoints {
  void begin(const TrajectoryGoal& goal, Window window = {}) {
    auto planned = plan(goal);
    ASSERT_TRUE(planned) << planned.error().text;
    motion.emplace(std::move(*planned), joints, start, start, window);
  }
  /// The changes that are handed over at a time after the start, or just before it.
  std::vector<std::size_t> taken(Duration after) {
    const Time at = start + (after > Duration::zero() ? after : Duration(microseconds(-1)));
    motion->step(at, positions);
    std::vector<std::size_t> changes;
    while (const auto change = motion->take_change(at)) changes.push_back(*change);
    return changes;
  }
  /// The device accepts a change, with its number plus 100.
  void accept(std::size_t change, bool by_device = true) {
    motion->on_answer(change, {static_cast<std::uint32_t>(change) + 100, "", by_device});
  }
  void outcome(std::size_t change, Result result, const std::string& reason = "", Duration late = {}) {
    ScheduledOutcome told;
    told.number = static_cast<std::uint32_t>(change) + 100;
    told.result = result;
    told.reason = reason;
    told.due = motion->due(change);
    told.at = {told.due + late, microseconds(30)};
    EXPECT_TRUE(motion->on_outcome(told));
  }
  std::optional<TrajectoryResult> result_at(Duration after) {
    motion->step(start + after, positions);
    return motion->take_result();
  }

  Time start = now();
  std::optional<JointPosition> is;
  TrajectoryMotion::Positions positions = [this](std::size_t) { return is; };
  std::optional<TrajectoryMotion> motion;
};

TEST_F(TrajectoryMotionTest, Only_changes_within_the_horizon_are_handed_over) {
  begin(goal("glue", {0, 1, 0, 1}), {milliseconds(600), 32});  // at 0, 0.5, 1.5 and 2.5 s
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1));
  EXPECT_THAT(taken(milliseconds(899)), IsEmpty());
  EXPECT_EQ(motion->step(start + milliseconds(899), positions), start + milliseconds(900));
  EXPECT_THAT(taken(milliseconds(900)), ElementsAre(2));
}

TEST_F(TrajectoryMotionTest, It_ends_when_all_is_done_and_its_last_point_is_reached) {
  begin(goal("glue", {0, 1}));
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1));
  accept(0);
  accept(1);
  outcome(0, Result::done, "", microseconds(61));
  outcome(1, Result::done, "", microseconds(20));
  EXPECT_FALSE(result_at(milliseconds(600)));
  EXPECT_EQ(motion->step(start + milliseconds(600), positions), start + seconds(1));
  const auto result = result_at(seconds(1));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::done);
  EXPECT_EQ(result->code, TrajectoryCode::successful);
  EXPECT_EQ(result->text, "2 changes, at most 0.061 ms late (± 0.030)");
  EXPECT_FALSE(result_at(seconds(2))) << "one result";
}

TEST_F(TrajectoryMotionTest, No_more_changes_are_under_way_than_there_is_room_for) {
  begin(goal("speed", {1, 2, 3, 4}), {seconds(10), 2});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1));
  accept(0);
  accept(1);
  EXPECT_THAT(taken(milliseconds(1)), IsEmpty());
  outcome(0, Result::done);
  EXPECT_THAT(taken(milliseconds(2)), ElementsAre(2));
}

TEST_F(TrajectoryMotionTest, A_change_waits_for_room_at_the_device_until_it_is_due) {
  begin(goal("speed", {1, 2, 3, 4}), {seconds(10), 32});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1, 2, 3));
  accept(0);
  accept(1);
  motion->on_answer(2, {0, "too many", false, true});
  motion->on_answer(3, {0, "too many", false, true});
  EXPECT_THAT(taken(milliseconds(1)), IsEmpty());
  outcome(0, Result::done);
  EXPECT_THAT(taken(milliseconds(2)), ElementsAre(2, 3)) << "each outcome may have made room for one more";
  accept(2);
  motion->on_answer(3, {0, "too many", false, true});
  EXPECT_THAT(taken(milliseconds(3)), IsEmpty());
  EXPECT_THAT(taken(milliseconds(23)), IsEmpty()) << "two are under way";
  outcome(1, Result::done);
  outcome(2, Result::done);
  EXPECT_THAT(taken(milliseconds(2001)), ElementsAre(3));
  motion->on_answer(3, {0, "too many", false, true});
  EXPECT_FALSE(result_at(milliseconds(2999)));
  const auto result = result_at(milliseconds(3001));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::aborted);
  EXPECT_THAT(result->text, HasSubstr("speed to 4 at 3.000 s: the device had no free place"));
}

TEST_F(TrajectoryMotionTest, The_next_change_of_a_joint_waits_for_one_that_is_late_or_the_drivers) {
  begin(goal("speed", {1, 2, 3}), {seconds(10), 32});
  EXPECT_THAT(taken(milliseconds(5)), ElementsAre(0)) << "it is late: the driver makes it";
  accept(0, false);
  EXPECT_THAT(taken(milliseconds(10)), IsEmpty());
  outcome(0, Result::done);
  EXPECT_THAT(taken(milliseconds(15)), ElementsAre(1, 2));
  accept(1);
  accept(2);
}

TEST_F(TrajectoryMotionTest, A_change_that_cannot_be_made_in_time_aborts_the_goal) {
  begin(goal("speed", {1, 2}), {seconds(10), 1});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0));
  EXPECT_FALSE(result_at(milliseconds(1200)));
  motion->step(start + milliseconds(1251), positions);
  accept(0);
  outcome(0, Result::done, "", milliseconds(300));
  EXPECT_TRUE(motion->take_withdrawal());
  motion->on_withdrawn();
  const auto result = motion->take_result();
  ASSERT_TRUE(result);
  EXPECT_THAT(result->text, HasSubstr("speed to 2 at 1.000 s: it could not be made in time"));
}

TEST_F(TrajectoryMotionTest, A_failure_ends_a_replaced_goal_unless_it_was_taken_back) {
  begin(goal("glue", {0, 1, 0}), {seconds(10), 32});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1, 2));
  for (const std::size_t change : {0U, 1U, 2U}) accept(change);
  motion->end(TrajectoryEnd::replaced, "a newer goal replaces it", start + seconds(1));
  motion->take_withdrawal();
  motion->on_withdrawn();
  outcome(2, Result::cancelled, "its client cancelled it");
  outcome(0, Result::failed, "the watchdog expired");
  EXPECT_TRUE(motion->take_withdrawal());
  motion->on_withdrawn();
  outcome(1, Result::cancelled, "its client cancelled it");
  const auto result = result_at(milliseconds(1));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::aborted);
  EXPECT_THAT(result->text, HasSubstr("the watchdog expired"));
}

TEST_F(TrajectoryMotionTest, A_goal_that_is_over_before_the_newer_one_begins_is_not_replaced) {
  begin(goal("glue", {0, 1}));
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1));
  motion->end(TrajectoryEnd::replaced, "a newer goal replaces it", start + seconds(2));
  EXPECT_FALSE(motion->is_ending());
}

TEST_F(TrajectoryMotionTest, A_change_that_fails_aborts_the_goal_once_the_others_are_taken_back) {
  begin(goal("glue", {0, 1, 0}), {seconds(10), 32});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1, 2));
  for (const std::size_t change : {0U, 1U, 2U}) accept(change);
  outcome(0, Result::done);
  outcome(1, Result::failed, "the output could not be driven");
  const auto withdrawal = motion->take_withdrawal();
  ASSERT_TRUE(withdrawal);
  EXPECT_EQ(withdrawal->how, TrajectoryEnd::aborted);
  EXPECT_FALSE(result_at(milliseconds(600)));
  motion->on_withdrawn();
  EXPECT_FALSE(result_at(milliseconds(700))) << "it is not known yet what became of the third";
  outcome(2, Result::cancelled);
  const auto result = result_at(milliseconds(800));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::aborted);
  EXPECT_EQ(result->code, TrajectoryCode::path_tolerance_violated);
  EXPECT_EQ(result->text,
            "glue to 1 at 0.500 s: the output could not be driven; 1 of 3 changes had been made");
}

TEST_F(TrajectoryMotionTest, A_refused_change_aborts_the_goal) {
  begin(goal("glue", {0, 1}));
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1));
  motion->on_answer(0, {0, "the device refuses it"});
  motion->on_answer(1, {0, "the device refuses it"});
  EXPECT_FALSE(result_at(milliseconds(1)));
  EXPECT_TRUE(motion->take_withdrawal());
  motion->on_withdrawn();
  EXPECT_EQ(result_at(milliseconds(2))->how, TrajectoryEnd::aborted);
}

TEST_F(TrajectoryMotionTest, An_outcome_may_come_before_the_answer) {
  begin(goal("glue", {1}));
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0));
  ScheduledOutcome early;
  early.number = 100;
  early.result = Result::unknown;
  early.reason = "the connection ended";
  EXPECT_FALSE(motion->on_outcome(early));
  accept(0);
  motion->take_withdrawal();
  EXPECT_THAT(result_at(milliseconds(1))->text, HasSubstr("the connection ended"));
}

TEST_F(TrajectoryMotionTest, A_replaced_goal_does_what_comes_before_the_newer_one) {
  begin(goal("glue", {0, 1, 0}), {milliseconds(10), 32});  // at 0, 0.5 and 1.5 s
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0));
  accept(0);
  outcome(0, Result::done);
  motion->end(TrajectoryEnd::replaced, "a newer goal replaces it", start + seconds(1));
  EXPECT_FALSE(motion->take_withdrawal()) << "nothing was handed over";
  EXPECT_FALSE(result_at(milliseconds(400)));
  EXPECT_THAT(taken(milliseconds(495)), ElementsAre(1));
  accept(1);
  outcome(1, Result::done);
  const auto result = result_at(milliseconds(501));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::replaced);
  EXPECT_EQ(result->text, "a newer goal replaces it; 2 of 3 changes had been made");
}

TEST_F(TrajectoryMotionTest, A_replaced_goal_can_still_be_stopped) {
  begin(goal("glue", {0, 1, 0}), {seconds(10), 32});
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0, 1, 2));
  for (const std::size_t change : {0U, 1U, 2U}) accept(change);
  outcome(0, Result::done);
  motion->end(TrajectoryEnd::replaced, "a newer goal replaces it", start + seconds(1));
  EXPECT_EQ(motion->take_withdrawal()->from, start + seconds(1));
  motion->end(TrajectoryEnd::aborted, "safe values were requested");
  EXPECT_EQ(motion->take_withdrawal()->from, Time::min());
  motion->on_withdrawn();
  outcome(2, Result::cancelled);
  outcome(1, Result::cancelled);
  EXPECT_FALSE(result_at(milliseconds(1))) << "the second withdrawal has no answer";
  motion->on_withdrawn();
  const auto result = result_at(milliseconds(2));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->how, TrajectoryEnd::aborted);
  EXPECT_EQ(result->text, "safe values were requested; 1 of 3 changes had been made");
}

TEST_F(TrajectoryMotionTest, A_tool_is_driven_when_it_is_due_and_its_result_counts) {
  begin(goal("clamp", {0, 1}));
  EXPECT_THAT(taken(microseconds(1)), ElementsAre(0));
  motion->on_tool(0, {ToolResult::How::reached, ""});
  EXPECT_THAT(taken(milliseconds(499)), IsEmpty());
  EXPECT_THAT(taken(milliseconds(500)), ElementsAre(1));
  EXPECT_FALSE(result_at(seconds(1))) << "it has not arrived";
  motion->on_tool(1, {ToolResult::How::stuck, "stuck"});
  motion->take_withdrawal();
  const auto result = result_at(seconds(1));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->text, "clamp to 1 at 0.500 s: stuck; 1 of 2 changes had been made");
}

TEST_F(TrajectoryMotionTest, A_change_of_a_tool_may_be_replaced_by_the_next_one) {
  begin(goal("clamp", {0, 1}));
  EXPECT_THAT(taken(microseconds(1)), ElementsAre(0));
  EXPECT_THAT(taken(milliseconds(500)), ElementsAre(1));
  motion->on_tool(0, {ToolResult::How::replaced, "a newer goal"});
  motion->on_tool(1, {ToolResult::How::reached, ""});
  EXPECT_EQ(result_at(seconds(1))->how, TrajectoryEnd::done);
}

TEST_F(TrajectoryMotionTest, A_cancelled_goal_waits_for_its_tools) {
  begin(goal("clamp", {0, 1}));
  EXPECT_THAT(taken(microseconds(1)), ElementsAre(0));
  motion->end(TrajectoryEnd::cancelled, "cancelled");
  EXPECT_EQ(motion->take_withdrawal()->how, TrajectoryEnd::cancelled);
  motion->on_withdrawn();
  EXPECT_FALSE(result_at(milliseconds(1)));
  motion->on_tool(0, {ToolResult::How::cancelled, "cancelled"});
  EXPECT_EQ(result_at(milliseconds(2))->how, TrajectoryEnd::cancelled);
}

TEST_F(TrajectoryMotionTest, An_axis_out_of_its_tolerance_aborts_the_goal_after_the_time_for_it) {
  TrajectoryGoal tolerant = goal("speed", {100});
  tolerant.goal_tolerance = {{"speed", 5}};
  tolerant.goal_time_tolerance = milliseconds(300);
  begin(tolerant);
  EXPECT_THAT(taken(Duration::zero()), ElementsAre(0));
  accept(0);
  outcome(0, Result::done);
  is = JointPosition{100, start};
  EXPECT_FALSE(result_at(milliseconds(1))) << "the position is from before";
  is = JointPosition{80, start + milliseconds(50)};
  EXPECT_FALSE(result_at(milliseconds(100)));
  const auto result = result_at(milliseconds(301));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->code, TrajectoryCode::goal_tolerance_violated);
  EXPECT_THAT(result->text, HasSubstr("speed is at 80, which is not within 5 of 100"));
}

}  // namespace
}  // namespace coupler::host
