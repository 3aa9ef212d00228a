// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/arguments.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Arguments parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "coupler_driver");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  return parse_arguments(pointers);
}

TEST(Arguments, Options_stand_before_ROSs_own_and_behind_them) {
  const Arguments result = parse(
      {"--map", "a.yaml", "--ros-args", "-p", "rate:=5", "--", "--port", "1502", "--ros-args", "-r", "a:=b"});
  EXPECT_FALSE(result.exit_code) << result.text;
  EXPECT_EQ(result.settings.map, "a.yaml");
  EXPECT_EQ(result.settings.port, 1502);
  EXPECT_FALSE(result.settings.rate) << "a parameter, not an option";
  EXPECT_THAT(result.for_ros,
              ElementsAre("coupler_driver", "--ros-args", "-p", "rate:=5", "--", "--ros-args", "-r", "a:=b"));
}

TEST(Arguments, The_node_may_be_given_its_name) {
  EXPECT_TRUE(parse({"--ros-args", "-r", "__node:=cell_io"}).names_the_node);
  EXPECT_FALSE(parse({"--name", "cell", "--ros-args", "-r", "__ns:=/cell"}).names_the_node);
}

TEST(Arguments, ROS_1s_spelling_is_a_wrong_call_told_with_that_of_ROS_2) {
  const auto told = [](const char* argument) {
    const Arguments result = parse({argument});
    EXPECT_EQ(result.exit_code, 2) << argument;
    return result.text;
  };
  EXPECT_THAT(told("_map:=a.yaml"), HasSubstr("--ros-args -p map:=a.yaml"));
  EXPECT_THAT(told("_belt/port:=503"), HasSubstr("--ros-args -p belt.port:=503"));
  EXPECT_THAT(told("__name:=cell"), HasSubstr("--ros-args -r __node:=cell"));
  EXPECT_THAT(told("__ns:=/cell"), HasSubstr("--ros-args -r __ns:=/cell"));
  EXPECT_THAT(told("lamp:=light"), HasSubstr("--ros-args -r lamp:=light"));
}

TEST(Arguments, ROSs_own_without_ros_args_are_told_where_they_belong) {
  for (const char* argument : {"-p", "--remap", "-e", "--enclave", "--params-file", "--log-config-file"})
    EXPECT_EQ(parse({argument, "what:=ever"}).text,
              std::string(argument) + ": arguments of ROS 2 come after --ros-args\n");
  EXPECT_EQ(parse({"--disable-rosout-logs", "--map", "a.yaml"}).text,
            "--disable-rosout-logs: arguments of ROS 2 come after --ros-args\n");
}

TEST(Arguments, Remappings_are_those_of_topics_and_services_for_this_node) {
  const auto from = [](const std::string& rule) {
    const auto found = remappings_of({"coupler_driver", "--ros-args", "-r", rule}, "press_driver");
    return found.empty() ? std::string() : found.front().from + " to " + found.front().to;
  };
  EXPECT_EQ(from("press/lamp:=light"), "press/lamp to light");
  EXPECT_EQ(from("press_driver:press/lamp:=light"), "press/lamp to light");
  EXPECT_EQ(from("rostopic://press/lamp:=light"), "press/lamp to light");
  EXPECT_EQ(from("press_driver:rosservice:///press/safe:=off"), "/press/safe to off");
  for (const char* const other :
       {"belt_driver:press/lamp:=light", "__node:=io", "press_driver:__node:=io", "__ns:=/cell"})
    EXPECT_EQ(from(other), "") << other;
  EXPECT_EQ(
      remappings_of({"coupler_driver", "--ros-args", "--remap", "a:=b", "-p", "c:=d", "-r", "e:=f"}, "io")
          .size(),
      2U);
}

TEST(Arguments, A_misspelt_option_is_a_wrong_call) {
  EXPECT_EQ(parse({"--raet", "5"}).exit_code, 2);
  EXPECT_THAT(parse({"--port", "0"}).text, HasSubstr("a whole number from 1 to 65535"));
}

TEST(Arguments, Help_has_ROS_2s_examples) {
  const Arguments result = parse({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.text, HasSubstr("ros2 run coupler_driver coupler_driver --ros-args -p map:="));
}

}  // namespace
}  // namespace coupler::host
