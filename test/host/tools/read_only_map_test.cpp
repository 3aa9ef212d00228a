// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/read_only_map.hpp"

#include <gtest/gtest.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::tools {
namespace {

struct OnlyLookingAt : testing::Test {
  OnlyLookingAt() {
    owned = fakes::MapBuilder()
                .add(Table::coils, "lamp", 3, codec::Type::BOOL,
                     [](Point& point) { point.host.deadman.timeout = std::chrono::milliseconds(500); })
                .build();
    map = owned->map();
    map.on_reconnect = OnReconnect::restore;
    map.on_shutdown = OnShutdown::safe;
    map.poll = Poll::subscribed;
    map.coupler_watchdog.timeout = std::chrono::milliseconds(500);
  }
  MapPtr owned;
  Map map;
};

TEST_F(OnlyLookingAt, Nothing_of_what_a_driver_does_by_itself_is_left) {
  const ReadOnlyMap looking(map);
  EXPECT_EQ(looking.map().on_reconnect, OnReconnect::drop);
  EXPECT_EQ(looking.map().on_shutdown, OnShutdown::hold);
  EXPECT_EQ(looking.map().poll, Poll::all);
  EXPECT_FALSE(looking.map().coupler_watchdog.present());
  ASSERT_EQ(looking.map().points.size(), 1U);
  EXPECT_FALSE(looking.map().points[0].host.deadman.present());
  EXPECT_TRUE(map.points[0].host.deadman.present()) << "of the map that was given";
}

}  // namespace
}  // namespace coupler::tools
