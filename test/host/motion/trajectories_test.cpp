// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectories.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "test/host/motion/sample_joints.hpp"

namespace coupler::host {
namespace {

using TrajectoryEnd = TrajectoryResult::How;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// What is scheduled is accepted at once, with numbers from 1 on.
struct TrajectoriesTest : SampleJoints {
  TrajectoriesTest() { trajectories.on_online(true); }

  /// The first point is a little after the start, so that it is not late.
  void begin(TrajectoryGoal goal, std::uint64_t number = 1) {
    for (TrajectoryGoal::Waypoint& point : goal.points) point.from_start += milliseconds(200);
    trajectories.begin({this, number}, goal, now(),
                       [this](const TrajectoryResult& result) { results.push_back(result); });
    trajectories.step(now());
  }
  void outcome(std::uint32_t number, ScheduledOutcome::Result result, const std::string& reason = "") {
    ScheduledOutcome told;
    told.number = number;
    told.result = result;
    told.reason = reason;
    told.due = scheduled[number - 1].due;
    told.at = {told.due, {}};
    EXPECT_TRUE(trajectories.on_scheduled(told));
    trajectories.step(now() + std::chrono::seconds(5));
  }

  std::vector<ScheduledWrite> scheduled;
  std::vector<std::vector<std::uint32_t>> cancelled;
  std::vector<TrajectoryResult> results;
  Trajectories trajectories{map->map(),
                            joints,
                            tools,
                            {},
                            {[this](const ScheduledWrite& what, const Reply<ScheduleAnswer>::Give& give) {
                               scheduled.push_back(what);
                               give({static_cast<std::uint32_t>(scheduled.size()), "accepted"});
                             },
                             [this](WritesFrom which, const Reply<CallAnswer>::Give& give) {
                               cancelled.push_back(std::move(which.points));
                               give({true, "cancelled"});
                             },
                             [] {}}};
};

TEST_F(TrajectoriesTest, Changes_of_axes_are_scheduled_with_their_times) {
  begin(goal("glue", {0, 1}));
  ASSERT_THAT(scheduled, SizeIs(2));
  EXPECT_EQ(scheduled[1].write.point, index("valve_glue"));
  EXPECT_TRUE(scheduled[1].write.bit(0));
  EXPECT_EQ(scheduled[1].due - scheduled[0].due, milliseconds(500));
  EXPECT_GT(scheduled[0].may_be_late, Duration::zero());
  EXPECT_GT(scheduled[0].asked.count(), 0);
}

TEST_F(TrajectoriesTest, A_goal_that_cannot_be_is_answered_in_the_step) {
  begin(goal("glu", {0}));
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].code, TrajectoryCode::invalid_joints);
  TrajectoryGoal old = goal("glue", {0});
  old.start = std::chrono::seconds(1);
  begin(old);
  ASSERT_THAT(results, SizeIs(2));
  EXPECT_EQ(results[1].code, TrajectoryCode::old_header_timestamp);
  EXPECT_THAT(scheduled, IsEmpty());
}

TEST_F(TrajectoriesTest, A_cancelled_goal_takes_back_its_axes) {
  begin(goal("glue", {0, 1}));
  trajectories.cancel({this, 7});
  trajectories.step(now());
  EXPECT_THAT(cancelled, IsEmpty()) << "that is another goal";
  trajectories.cancel({this, 1});
  trajectories.step(now());
  EXPECT_THAT(cancelled, ElementsAre(ElementsAre(index("valve_glue"))));
  EXPECT_THAT(results, IsEmpty());
  outcome(1, ScheduledOutcome::Result::done);
  outcome(2, ScheduledOutcome::Result::cancelled);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].how, TrajectoryEnd::cancelled);
  EXPECT_EQ(results[0].text, "cancelled; 1 of 2 changes had been made");
}

TEST_F(TrajectoriesTest, A_newer_goal_replaces_the_one_before) {
  begin(goal("glue", {1}));
  begin(goal("speed", {5}), 2);
  outcome(1, ScheduledOutcome::Result::cancelled);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].how, TrajectoryEnd::replaced);
  outcome(2, ScheduledOutcome::Result::done);
  ASSERT_THAT(results, SizeIs(2));
  EXPECT_EQ(results[1].how, TrajectoryEnd::done);
}

TEST_F(TrajectoriesTest, A_write_by_somebody_else_aborts_the_goal_of_its_axis_only) {
  begin(goal("glue", {0, 1}));
  trajectories.disturb(index("speed"), "speed was written directly");
  trajectories.step(now());
  EXPECT_THAT(cancelled, IsEmpty());
  trajectories.disturb(index("valve_glue"), "valve_glue was written directly");
  trajectories.step(now());
  outcome(1, ScheduledOutcome::Result::cancelled);
  outcome(2, ScheduledOutcome::Result::cancelled);
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].how, TrajectoryEnd::aborted);
  EXPECT_THAT(results[0].text, HasSubstr("valve_glue was written directly; 0 of 2"));
}

TEST_F(TrajectoriesTest, A_device_that_goes_offline_aborts_goals_and_takes_none) {
  begin(goal("glue", {0, 1}));
  trajectories.on_online(false);
  trajectories.step(now());
  outcome(1, ScheduledOutcome::Result::unknown, "the connection ended");
  outcome(2, ScheduledOutcome::Result::unknown, "the connection ended");
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_THAT(results[0].text, HasSubstr("offline"));
  begin(goal("glue", {1}), 2);
  ASSERT_THAT(results, SizeIs(2));
  EXPECT_EQ(results[1].how, TrajectoryEnd::aborted);
}

TEST_F(TrajectoriesTest, A_tool_is_driven_by_its_own_rules) {
  begin(goal("clamp", {1}));
  trajectories.step(now() + milliseconds(200));
  tools.step(now());
  ASSERT_THAT(tool_writes, SizeIs(1));
  EXPECT_EQ(tool_writes[0].point, index("valve_close"));
  EXPECT_FALSE(tool_writes[0].bit(0)) << "its partner is off first";
  tool_writes[0].listener->on_result({WriteResult::Outcome::dropped});
  tools.step(now());
  trajectories.step(now());
  trajectories.step(now());
  ASSERT_THAT(results, SizeIs(1));
  EXPECT_EQ(results[0].how, TrajectoryEnd::aborted);
}

TEST_F(TrajectoriesTest, After_the_end_each_goal_is_aborted) {
  begin(goal("speed", {5}));
  trajectories.end("the driver ends");
  trajectories.step(now());
  outcome(1, ScheduledOutcome::Result::cancelled);
  begin(goal("speed", {5}), 2);
  ASSERT_THAT(results, SizeIs(2));
  EXPECT_THAT(results[0].text, HasSubstr("the driver ends"));
  EXPECT_EQ(results[1].text, "the driver ends");
}

TEST_F(TrajectoriesTest, The_progress_of_a_goal_is_known_until_it_ends) {
  TrajectoryGoal slow = goal("speed", {0, 100});
  begin(slow);
  const auto progress = trajectories.progress(now());
  ASSERT_TRUE(progress);
  EXPECT_EQ(progress->key.number, 1U);
  EXPECT_THAT(progress->desired, SizeIs(1));
  trajectories.cancel({this, 1});
  EXPECT_FALSE(trajectories.progress(now()));
}

}  // namespace
}  // namespace coupler::host
