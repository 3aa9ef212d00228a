// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/parameters.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = GivenParameter::Kind;
using Section = GivenParameters::Section;

GivenParameter text(const char* name, const char* value) { return {name, Kind::text, value}; }

std::vector<std::string> names_for(const std::vector<Section>& sections, std::string_view node) {
  std::vector<std::string> names;
  for (const GivenParameter& one : GivenParameters(sections).for_node(node)) names.push_back(one.name);
  return names;
}

TEST(GivenParameters, A_pattern_fits_as_many_names_as_it_has_stars) {
  const std::vector<Section> sections{{"/**", {text("a", "1")}},
                                      {"/*", {text("b", "1")}},
                                      {"/cell/*", {text("c", "1")}},
                                      {"/cell/**/press_driver", {text("d", "1")}},
                                      {"/cell/press_driver", {text("e", "1")}},
                                      {"/press_driver", {text("f", "1")}}};
  EXPECT_THAT(names_for(sections, "/cell/press_driver"), ElementsAre("a", "c", "d", "e"));
  EXPECT_THAT(names_for(sections, "/press_driver"), ElementsAre("a", "b", "f"));
  EXPECT_THAT(names_for(sections, ""), ElementsAre("a")) << "before the node has a name";
}

TEST(GivenParameters, The_last_one_that_is_given_counts) {
  const auto settings = settings_among({text("address", "one"), text("address", "two")}, "");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->address, "two");
}

TEST(GivenParameters, What_YAML_made_of_a_word_is_understood) {
  const auto settings = settings_among({{"verify", Kind::boolean, "false"},
                                        {"address", Kind::list, "::1"},
                                        {"rate", Kind::integer, "5"},
                                        {"port", Kind::text, "1502"}},
                                       "");
  ASSERT_TRUE(settings) << settings.error();
  EXPECT_EQ(settings->verify, Verify::off);
  EXPECT_EQ(settings->address, "::1");
  EXPECT_EQ(settings->rate, 5);
  EXPECT_EQ(settings->port, 1502);
  EXPECT_THAT(settings_among({{"name", Kind::integer, "42"}}, "").error(), HasSubstr("'42' is not a name"));
}

TEST(GivenParameters, What_YAML_has_made_unreadable_is_refused_with_quotes) {
  EXPECT_THAT(settings_among({{"name", Kind::boolean, "true"}}, "").error(), HasSubstr("name: 'VALUE'"));
  EXPECT_THAT(settings_among({{"name", Kind::real, "1000"}}, "").error(), HasSubstr("put it into quotes"));
  EXPECT_THAT(settings_among({text("verify", "maybe")}, "").error(), HasSubstr("require, warn or off"));
}

TEST(GivenParameters, An_empty_text_says_nothing) {
  const auto settings = settings_among({text("map", ""), text("port", ""), {"maps", Kind::list, ""}}, "");
  ASSERT_TRUE(settings);
  EXPECT_FALSE(settings->map);
  EXPECT_FALSE(settings->port);
  EXPECT_TRUE(settings->maps.empty());
}

TEST(GivenParameters, Those_of_one_device_stand_below_its_name) {
  const auto settings = settings_among({text("address", "one"), text("belt.address", "two")}, "belt.");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->address, "two");
}

TEST(GivenParameters, A_misspelt_one_of_the_node_is_told_with_the_nearest) {
  const GivenParameters given({{"/press_driver", {text("addres", "one"), text("speed", "2")}}});
  EXPECT_THAT(given.unknown("/press_driver", {}),
              ElementsAre(HasSubstr("addres is not a setting and does nothing; did you mean 'address'?"),
                          HasSubstr("speed is not a setting")));
}

TEST(GivenParameters, Of_those_for_all_nodes_only_near_misses_are_told) {
  const GivenParameters given(
      {{"/**", {text("addres", "one"), text("speed", "2"), text("qos_overrides./clock.depth", "1")}}});
  EXPECT_THAT(given.unknown("/press_driver", {}), ElementsAre(HasSubstr("addres")));
}

TEST(GivenParameters, Those_of_several_devices_are_settings) {
  const GivenParameters given({{"/press_driver", {text("belt.address", "one"), text("belt.speed", "2")}}});
  EXPECT_THAT(given.unknown("/press_driver", {"belt"}), ElementsAre(HasSubstr("belt.speed")));
}

TEST(GivenParameters, Those_of_a_device_that_is_not_there_are_told) {
  const GivenParameters given({{"/**", {text("bellt.address", "one")}}});
  EXPECT_THAT(given.unknown("/press_driver", {"press", "belt"}),
              ElementsAre(HasSubstr("the names press, belt")));
  EXPECT_THAT(given.unknown("/press_driver", {}), IsEmpty()) << "of other nodes, maybe";
}

TEST(GivenParameters, A_section_for_a_driver_of_another_name_is_told_unless_this_one_has_its_own) {
  const Section other{"/pres_driver", {text("map", "a.yaml")}};
  EXPECT_THAT(
      GivenParameters({other}).unknown("/press_driver", {}),
      ElementsAre("the parameters of /pres_driver are not used: the name of this node is /press_driver"));
  EXPECT_THAT(GivenParameters({other, {"/press_driver", {text("rate", "5")}}}).unknown("/press_driver", {}),
              IsEmpty());
  EXPECT_THAT(GivenParameters({{"/camera", {text("exposure", "5")}}}).unknown("/press_driver", {}),
              IsEmpty());
}

}  // namespace
}  // namespace coupler::host
