// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/remapping_check.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// What a driver of one device with two points says of a remapping.
std::vector<std::string> unused(const std::string& from, const std::string& space = "/") {
  RemappingCheck check({{from, "x"}}, space);
  for (const char* const name : {"press/lamp", "press/lamp/write", "press/flow"}) check.add_name(name, true);
  for (const char* const name : {"press/online", "press/safe", "press/lamp/set"}) check.add_name(name, false);
  return check.unused({"press"});
}

TEST(RemappingCheck, One_of_a_topic_or_a_service_is_used) {
  for (const char* const from :
       {"press/lamp", "/press/lamp", "press/lamp/write", "press/safe", "press/lamp/set"})
    EXPECT_THAT(unused(from), IsEmpty()) << from;
}

TEST(RemappingCheck, A_misspelt_one_is_told_with_the_nearest_name) {
  EXPECT_THAT(unused("press/lmap"),
              ElementsAre("the remapping press/lmap:=x changes nothing: this driver has no topic or service "
                          "press/lmap; did you mean press/lamp?"));
  EXPECT_THAT(unused("pres/lamp").size(), 1U);
}

TEST(RemappingCheck, One_below_the_device_is_told_though_nothing_is_near) {
  EXPECT_THAT(
      unused("press/conveyor_speed"),
      ElementsAre("the remapping press/conveyor_speed:=x changes nothing: this driver has no topic or "
                  "service press/conveyor_speed"));
}

TEST(RemappingCheck, A_point_without_its_device_is_told) {
  EXPECT_THAT(
      unused("flow"),
      ElementsAre("the remapping flow:=x changes nothing: this driver has no topic or service flow; did "
                  "you mean press/flow?"));
}

TEST(RemappingCheck, Those_for_other_nodes_are_not_told) {
  for (const char* const from : {"rosout", "/tf", "/clock", "/diagnostics", "cmd_vel", "online", "safe",
                                 "~rate", "/other/press/lamp", "press", "pressed/lamp_of_another"})
    EXPECT_THAT(unused(from), IsEmpty()) << from;
}

TEST(RemappingCheck, A_whole_name_is_one_in_the_namespace_of_the_node) {
  EXPECT_THAT(unused("/cell/press/lamp", "/cell"), IsEmpty());
  EXPECT_THAT(unused("/cell/press/lmap", "/cell").size(), 1U);
  EXPECT_THAT(unused("/press/lmap", "/cell"), IsEmpty()) << "of another namespace";
}

}  // namespace
}  // namespace coupler::host
