// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/settings.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

TEST(Settings, The_stronger_side_wins_where_it_says_something) {
  Settings parameters;
  parameters.port = 1;
  parameters.rate = 5;
  Settings arguments;
  arguments.port = 2;
  const Settings both = overlay(parameters, arguments);
  EXPECT_EQ(both.port, 2);
  EXPECT_EQ(both.rate, 5);
}

TEST(Settings, A_map_and_several_maps_are_one_thing_to_say) {
  Settings parameters;
  parameters.maps = {"a.yaml", "b.yaml"};
  Settings arguments;
  arguments.map = "c.yaml";
  EXPECT_EQ(overlay(parameters, {}).maps.size(), 2U);
  EXPECT_TRUE(overlay(parameters, arguments).maps.empty());
  EXPECT_FALSE(overlay(arguments, parameters).map);
}

TEST(Settings, What_is_not_set_stays_as_the_map_has_it) {
  Map map;
  map.name = "device";
  map.connection.port = 1502;
  map.poll = Poll::subscribed;
  Settings settings;
  settings.unit = 9;
  apply(settings, map);
  EXPECT_EQ(map.poll, Poll::subscribed);
  settings.poll = Poll::all;
  apply(settings, map);
  EXPECT_EQ(map.poll, Poll::all);
  EXPECT_EQ(map.name, "device");
  EXPECT_EQ(map.connection.port, 1502);
  EXPECT_EQ(map.connection.unit, 9);
}

}  // namespace
}  // namespace coupler::host
