// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/trajectory_plan.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "test/host/motion/sample_joints.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

struct TrajectoryPlanTest : SampleJoints {
  /// "0.500: 1", the time in seconds and the position, of each change.
  std::vector<std::string> changes(const TrajectoryGoal& goal) {
    std::vector<std::string> texts;
    const auto planned = plan(goal);
    EXPECT_TRUE(planned) << (planned ? "" : planned.error().text);
    if (!planned) return texts;
    for (const JointChange& change : planned->changes)
      texts.push_back(
          fmt::format("{:.3f}: {}", std::chrono::duration<double>(change.at).count(), change.position));
    return texts;
  }
  void expect_refused(const TrajectoryGoal& goal, TrajectoryCode code, const std::string& text) {
    const auto planned = plan(goal);
    ASSERT_FALSE(planned) << text;
    EXPECT_EQ(planned.error().code, code);
    EXPECT_THAT(planned.error().text, HasSubstr(text));
  }
};

TEST_F(TrajectoryPlanTest, A_switch_changes_where_the_line_crosses_the_middle) {
  EXPECT_THAT(changes(goal("glue", {0, 1, 0})), ElementsAre("0.000: 0", "0.500: 1", "1.500: 0"));
}

TEST_F(TrajectoryPlanTest, Fifty_points_between_make_one_change) {
  TrajectoryGoal many;
  many.joints = {"glue"};
  for (int i = 0; i <= 50; ++i) many.points.push_back({{i / 50.0}, milliseconds(20 * i)});
  EXPECT_THAT(changes(many), ElementsAre("0.000: 0", "0.500: 1"));
}

TEST_F(TrajectoryPlanTest, At_the_exact_middle_the_higher_position_counts) {
  EXPECT_THAT(changes(goal("glue", {0, 0.5, 0.5, 0})), ElementsAre("0.000: 0", "1.000: 1", "2.000: 0"));
}

TEST_F(TrajectoryPlanTest, A_line_over_several_positions_goes_through_each) {
  EXPECT_THAT(changes(goal("mode", {0, 4, 0})),
              ElementsAre("0.000: 0", "0.125: 1", "0.625: 4", "1.375: 1", "1.875: 0"));
  const auto planned = plan(goal("mode", {4}));
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->changes[0].value[0], 2) << "the value of fast";
}

TEST_F(TrajectoryPlanTest, A_number_has_the_value_of_each_point_from_its_time_on) {
  EXPECT_THAT(changes(goal("speed", {100, 250, 250, 300})),
              ElementsAre("0.000: 100", "1.000: 250", "3.000: 300"));
}

TEST_F(TrajectoryPlanTest, Points_of_a_number_whose_value_is_the_same_make_no_change) {
  EXPECT_THAT(changes(goal("speed", {100, 100.2, 99.6})), ElementsAre("0.000: 100"));
}

TEST_F(TrajectoryPlanTest, One_point_is_driven_at_its_time) {
  TrajectoryGoal one;
  one.joints = {"glue"};
  one.points = {{{1}, milliseconds(300)}};
  EXPECT_THAT(changes(one), ElementsAre("0.300: 1"));
}

TEST_F(TrajectoryPlanTest, A_tool_between_its_ends_is_driven_when_the_line_leads_to_one) {
  EXPECT_THAT(changes(goal("clamp", {0.5, 0.5, 1})), ElementsAre("1.000: 1"));
  EXPECT_THAT(changes(goal("clamp", {0.5, 0.45, 0.55})), IsEmpty());
  EXPECT_THAT(changes(goal("clamp", {0.35, 0.46, 1})), ElementsAre("1.000: 1"));
  EXPECT_THAT(changes(goal("clamp", {1, 0})), ElementsAre("0.000: 1", "0.500: 0"));
}

TEST_F(TrajectoryPlanTest, The_changes_of_all_joints_are_in_the_order_of_their_times) {
  TrajectoryGoal both;
  both.joints = {"speed", "glue"};
  both.points = {{{10, 0}, seconds(0)}, {{20, 1}, seconds(1)}};
  const auto planned = plan(both);
  ASSERT_TRUE(planned);
  EXPECT_THAT(planned->joints, ElementsAre(3, 1));
  std::vector<std::size_t> order;
  for (const JointChange& change : planned->changes) order.push_back(change.joint);
  EXPECT_THAT(order, ElementsAre(3, 1, 1, 3));
  EXPECT_DOUBLE_EQ(planned->position_at(0, milliseconds(250)), 12.5);
  EXPECT_DOUBLE_EQ(planned->position_at(1, seconds(5)), 1);
}

TEST_F(TrajectoryPlanTest, Joints_that_the_device_lacks_are_refused) {
  expect_refused(goal("glu", {1}), TrajectoryCode::invalid_joints, "did you mean 'glue'");
  expect_refused({}, TrajectoryCode::invalid_joints, "names no joints");
  TrajectoryGoal twice = goal("glue", {});
  twice.joints = {"glue", "glue"};
  twice.points = {{{0, 1}, seconds(0)}};
  expect_refused(twice, TrajectoryCode::invalid_joints, "twice");
}

TEST_F(TrajectoryPlanTest, Positions_that_cannot_be_are_refused_before_anything_is_driven) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(goal("glue", {0, nan}), TrajectoryCode::invalid_goal, "point 1");
  expect_refused(goal("glue", {0, 1.2}), TrajectoryCode::invalid_goal, "send 0 to 1");
  expect_refused(goal("speed", {70000}), TrajectoryCode::invalid_goal, "65535");
  expect_refused(goal("speed", {-1}), TrajectoryCode::invalid_goal, "does not fit");
  expect_refused(goal("speed", {1e300}), TrajectoryCode::invalid_goal, "does not fit");
  expect_refused(goal("force", {1e300}), TrajectoryCode::invalid_goal, "does not fit into REAL");
  EXPECT_TRUE(plan(goal("glue", {-0.1, 1.1})));
}

TEST_F(TrajectoryPlanTest, Points_that_are_no_trajectory_are_refused) {
  expect_refused(goal("glue", {}), TrajectoryCode::invalid_goal, "no points");
  TrajectoryGoal wrong = goal("glue", {0, 1});
  wrong.points[1].from_start = seconds(0);
  expect_refused(wrong, TrajectoryCode::invalid_goal, "not later");
  wrong.points[0].from_start = seconds(-1);
  expect_refused(wrong, TrajectoryCode::invalid_goal, "negative");
  wrong.points[0].positions = {0, 1};
  expect_refused(wrong, TrajectoryCode::invalid_goal, "2 positions for 1 joints");
  expect_refused(goal("speed", std::vector<double>(10'001, 1)), TrajectoryCode::invalid_goal,
                 "at most 10000");
  wrong = goal("glue", {0});
  wrong.is_multi_dof = true;
  expect_refused(wrong, TrajectoryCode::invalid_goal, "multi_dof");
}

TEST_F(TrajectoryPlanTest, There_is_a_most_of_changes) {
  std::vector<double> swings;
  for (int i = 0; i < 10'000; ++i) swings.push_back(i % 2 == 0 ? 0 : 4.2);
  expect_refused(goal("mode", swings), TrajectoryCode::invalid_goal, "changes");
}

TEST_F(TrajectoryPlanTest, A_tolerance_is_of_an_axis_of_the_goal) {
  TrajectoryGoal tolerant = goal("speed", {0, 100});
  tolerant.goal_tolerance = {{"speed", 5}};
  const auto planned = plan(tolerant);
  ASSERT_TRUE(planned);
  ASSERT_THAT(planned->tolerances, SizeIs(1));
  EXPECT_EQ(planned->tolerances[0].last, 100);
  EXPECT_EQ(planned->time_tolerance, seconds(1));
  tolerant.goal_tolerance = {{"glue", 5}};
  expect_refused(tolerant, TrajectoryCode::invalid_goal, "goal_tolerance names 'glue'");
}

}  // namespace
}  // namespace coupler::host
