// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/chosen_points.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct ChosenPointsTest : testing::Test {
  /// The names of the points that have topics.
  std::vector<std::string> chosen(const std::vector<std::string>& patterns) {
    const ChosenPoints points = choose_points(map->map(), patterns);
    warnings = points.warnings;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < points.has.size(); ++i)
      if (points.has[i]) names.emplace_back(map->map().points[i].name);
    return names;
  }

  MapPtr map = fakes::MapBuilder().coil("lamp", 0).coil("tank/valve", 1).coil("tank/pump", 2).build();
  std::vector<std::string> warnings;
};

TEST_F(ChosenPointsTest, Without_a_pattern_all_have_topics) {
  EXPECT_THAT(chosen({}), ElementsAre("lamp", "tank/valve", "tank/pump"));
}

TEST_F(ChosenPointsTest, A_pattern_is_one_of_a_shell) {
  EXPECT_THAT(chosen({"tank/*"}), ElementsAre("tank/valve", "tank/pump"));
  EXPECT_THAT(chosen({"*pump", "lam?"}), ElementsAre("lamp", "tank/pump"));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST_F(ChosenPointsTest, A_pattern_that_matches_nothing_is_told) {
  EXPECT_THAT(chosen({"lmap", "lamp"}), ElementsAre("lamp"));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("did you mean 'lamp'")));
}

TEST_F(ChosenPointsTest, Of_a_map_with_more_points_than_ROS_can_bear_the_first_have_topics) {
  map = fakes::MapBuilder().many(Table::holding_registers, 0, 10'001).build();
  EXPECT_EQ(chosen({}).size(), 10'000U);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("it has 10001 points, and only the first 10000")));
  EXPECT_EQ(chosen({"*"}).size(), 10'001U);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("10001 points have topics")));
}

}  // namespace
}  // namespace coupler::host
