// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/arguments.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using testing::HasSubstr;

Arguments parse(std::vector<std::string> arguments) {
  static std::vector<std::string> kept;  // the result refers to them
  kept = std::move(arguments);
  kept.insert(kept.begin(), "coupler_driver");
  std::vector<char*> pointers;
  for (std::string& argument : kept) pointers.push_back(argument.data());
  return parse_arguments(pointers);
}

TEST(Arguments, Both_spellings_mean_the_same) {
  EXPECT_EQ(parse({"_map:=a.yaml"}).settings.map, "a.yaml");
  EXPECT_EQ(parse({"--map", "a.yaml"}).settings.map, "a.yaml");
  EXPECT_EQ(parse({"--map=a.yaml"}).settings.map, "a.yaml");
}

TEST(Arguments, The_origins_name_of_the_map_is_understood) {
  EXPECT_EQ(parse({"_mapping:=a.yaml"}).settings.map, "a.yaml");
  EXPECT_EQ(parse({"--mapping", "a.yaml"}).settings.map, "a.yaml");
}

TEST(Arguments, What_was_meant_by_an_unexpected_one_is_proposed) {
  EXPECT_THAT(parse({"tx8.yaml"}).text, HasSubstr("not expected: tx8.yaml; did you mean --map tx8.yaml?"));
  EXPECT_THAT(parse({"left.yaml", "right.yaml"}).text,
              HasSubstr("; did you mean --maps left.yaml,right.yaml?"));
  // A shell makes a list of *.yaml, of which the option has got the first.
  const auto three = HasSubstr("; did you mean --maps a.yaml,b.yaml,c.yaml?");
  EXPECT_THAT(parse({"--maps", "a.yaml", "b.yaml", "c.yaml"}).text, three);
  EXPECT_THAT(parse({"--map", "a.yaml", "b.yaml", "c.yaml"}).text, three);
  EXPECT_THAT(parse({"_maps:=[a.yaml, 'b.yaml']", "c.yaml"}).text, three);
  EXPECT_THAT(parse({"--maps", "left=a.yaml", "right=b.yaml"}).text,
              HasSubstr("not expected: right=b.yaml; did you mean --maps left=a.yaml,right=b.yaml?"));
  EXPECT_THAT(parse({"--map", "a.yaml", "b.yaml"}).text, HasSubstr("; did you mean --maps a.yaml,b.yaml?"));
  EXPECT_THAT(parse({"--mpa", "tx8.yaml"}).text,
              HasSubstr("not expected: --mpa tx8.yaml; did you mean --map?"));
  EXPECT_THAT(parse({"--mpa=tx8.yaml"}).text, HasSubstr("did you mean --map?"));
  EXPECT_THAT(parse({"--speed", "5"}).text, HasSubstr("not expected: --speed 5 (this is coupler_driver"));
}

TEST(Arguments, It_is_known_whether_roslaunch_started_it) {
  EXPECT_FALSE(parse({"_map:=a.yaml", "__name:=io"}).by_roslaunch);
  EXPECT_TRUE(parse({"_map:=a.yaml", "__name:=io", "__log:=/tmp/io-1.log"}).by_roslaunch);
}

TEST(Arguments, Several_maps_are_a_list_in_each_spelling) {
  const std::vector<std::string> both{"a.yaml", "b.yaml"};
  EXPECT_EQ(parse({"_maps:=[a.yaml,b.yaml]"}).settings.maps, both);
  EXPECT_EQ(parse({"_maps:=[ 'a.yaml', \"b.yaml\" ]"}).settings.maps, both);
  EXPECT_EQ(parse({"--maps", "a.yaml,b.yaml"}).settings.maps, both);
  EXPECT_EQ(parse({"_maps:=[]"}).exit_code, 2);
}

TEST(Arguments, One_of_several_devices_may_have_its_own) {
  const Arguments result = parse({"_port:=502", "_belt/port:=503", "_cell/press/unit:=7", "_belt/rate:=5"});
  EXPECT_FALSE(result.exit_code) << result.text;
  EXPECT_EQ(result.settings.port, 502);
  ASSERT_EQ(result.of_devices.size(), 2U);
  EXPECT_EQ(result.of_devices.at("belt").port, 503);
  EXPECT_EQ(result.of_devices.at("belt").rate, 5);
  EXPECT_EQ(result.of_devices.at("cell/press").unit, 7);
  ASSERT_EQ(result.for_ros.size(), 2U) << "ROS would keep the others as parameters";
  EXPECT_STREQ(result.for_ros[1], "_port:=502");
}

TEST(Arguments, What_cannot_be_a_devices_own_is_a_wrong_call) {
  EXPECT_THAT(parse({"_belt/port:=0"}).text, HasSubstr("_belt/port: '0' is not a whole number"));
  EXPECT_THAT(parse({"_belt/speed:=1"}).text, HasSubstr("_belt/speed: there is no such setting"));
  EXPECT_THAT(parse({"_belt/map:=a.yaml"}).text, HasSubstr("_maps:="));
  const Arguments both = parse({"_belt/map:=a.yaml", "_belt/unit:=999"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.text, testing::AllOf(HasSubstr("_belt/map"), HasSubstr("_belt/unit"))) << "each is told";
}

TEST(Arguments, Each_setting_is_read) {
  const Settings s = parse({"_name:=arm", "_address:=::1", "_port:=1502", "_unit:=255", "_rate:=12.5",
                            "_timeout:=0.5", "_verify:=warn", "_poll:=subscribed"})
                         .settings;
  EXPECT_EQ(s.name, "arm");
  EXPECT_EQ(s.address, "::1");
  EXPECT_EQ(s.port, 1502);
  EXPECT_EQ(s.unit, 255);
  EXPECT_EQ(s.rate, 12.5);
  EXPECT_EQ(s.timeout, std::chrono::milliseconds(500));
  EXPECT_EQ(s.verify, Verify::warn);
  EXPECT_EQ(s.poll, Poll::subscribed);
}

TEST(Arguments, What_is_ROSs_own_is_passed_over) {
  const Arguments result = parse({"__log:=/tmp/log", "arm/lamp:=lamp", "__name:=arm_io"});
  EXPECT_FALSE(result.exit_code);
  EXPECT_TRUE(result.names_the_node);
  EXPECT_FALSE(parse({"_name:=arm"}).names_the_node);
}

TEST(Arguments, An_unknown_one_is_a_wrong_call) {
  for (const char* argument : {"--speed=1", "map.yaml"}) {
    const Arguments result = parse({argument});
    EXPECT_EQ(result.exit_code, 2) << argument;
    EXPECT_THAT(result.text, HasSubstr("not expected")) << argument;
  }
}

TEST(Arguments, A_misspelt_one_is_told_with_the_nearest) {
  const Arguments result = parse({"_pol:=subscribed"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.text, "_pol:=subscribed: there is no such setting; did you mean 'poll'?\n");
  EXPECT_THAT(
      parse({"_speed:=1"}).text,
      HasSubstr("_speed:=1: there is no such setting; see coupler_driver --help, or update coupler ("));
}

TEST(Arguments, A_value_out_of_range_is_a_wrong_call) {
  for (const char* argument :
       {"_port:=0", "_port:=65536", "_unit:=256", "_unit:=-1", "_unit:=1.5", "_rate:=0", "_rate:=nan",
        "_timeout:=0", "_timeout:=3h", "_verify:=yes", "_poll:=some", "--map=", "--rate="})
    EXPECT_EQ(parse({argument}).exit_code, 2) << argument;
}

TEST(Arguments, An_empty_parameter_says_nothing) {
  const Arguments result = parse({"_map:=a.yaml", "_rate:=", "_serial:=", "_maps:=", "_belt/port:="});
  EXPECT_FALSE(result.exit_code) << result.text;
  EXPECT_EQ(result.settings.map, "a.yaml");
  EXPECT_FALSE(result.settings.rate);
  EXPECT_FALSE(result.settings.serial);
  EXPECT_FALSE(result.of_devices.at("belt").port);
  EXPECT_THAT(parse({"_speed:="}).text, HasSubstr("there is no such setting"));
  EXPECT_THAT(parse({"_belt/speed:="}).text, HasSubstr("there is no such setting"));
}

TEST(Arguments, A_timeout_is_seconds_or_has_its_unit) {
  EXPECT_EQ(parse({"--timeout=60"}).settings.timeout, std::chrono::seconds(60));
  EXPECT_EQ(parse({"_timeout:=100ms"}).settings.timeout, std::chrono::milliseconds(100));
  EXPECT_EQ(parse({"--timeout", "90s"}).settings.timeout, std::chrono::seconds(90));
  EXPECT_EQ(parse({"--timeout=100"}).text,
            "timeout: '100' is not a number of seconds up to 60; write 100ms or 100s\n");
  EXPECT_EQ(parse({"--timeout=3h"}).text,
            "timeout: '3h' is not a duration from 0.001 to 3600 s, as 0.5, 500ms or 3s\n");
}

TEST(Arguments, Help_ends_with_0_and_has_an_example) {
  const Arguments result = parse({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.text, HasSubstr("coupler_driver _map:=device.yaml"));
}

}  // namespace
}  // namespace coupler::host
