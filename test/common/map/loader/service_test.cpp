// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;

TEST(Service, A_map_that_says_nothing_is_open_to_all_and_has_no_watchdog) {
  const MapPtr owned = test::load_with("");
  const Service& service = owned->map().service;
  EXPECT_EQ(service.listen, "");
  EXPECT_TRUE(service.allow.empty());
  EXPECT_FALSE(service.watchdog.present());
  EXPECT_FALSE(service.readback);
}

TEST(Service, The_watchdog_is_fed_by_anything_and_recovers_by_default) {
  const MapPtr owned = test::load_with("watchdog: {timeout: 500ms}");
  const Watchdog& watchdog = owned->map().service.watchdog;
  EXPECT_EQ(watchdog.timeout, 500ms);
  EXPECT_EQ(watchdog.fed_by, Watchdog::FedBy::any);
  EXPECT_EQ(watchdog.recovery, Watchdog::Recovery::automatic);
}

TEST(Service, All_of_it_is_read) {
  const MapPtr owned = test::load_with(
      "listen: 192.168.1.17\n"
      "allow: [192.168.1.0/24, 10.0.0.7, 'fd00::/8']\n"
      "watchdog: {timeout: 1s, fed_by: write, recovery: manual}\n"
      "readback: true");
  const Service& service = owned->map().service;
  EXPECT_EQ(service.listen, "192.168.1.17");
  ASSERT_EQ(service.allow.size(), 3U);
  EXPECT_EQ(service.allow[0], "192.168.1.0/24");
  EXPECT_EQ(service.allow[1], "10.0.0.7");
  EXPECT_EQ(service.allow[2], "fd00::/8");
  EXPECT_EQ(service.watchdog.timeout, 1s);
  EXPECT_EQ(service.watchdog.fed_by, Watchdog::FedBy::write);
  EXPECT_EQ(service.watchdog.recovery, Watchdog::Recovery::manual);
  EXPECT_TRUE(service.readback);
}

}  // namespace
}  // namespace coupler
