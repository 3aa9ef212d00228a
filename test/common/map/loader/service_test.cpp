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

TEST(Security, Without_it_everybody_may_do_everything) {
  EXPECT_FALSE(test::load_with("")->map().security.present());
}

TEST(Security, Roles_have_rights_by_the_names_of_points) {
  const MapPtr owned = test::load_clean(
      "name: cell\n"
      "security:\n"
      "  roles:\n"
      "    operator: {read: all, write: [lamp, 'valve_?']}\n"
      "    viewer: {read: [door, '*amp']}\n"
      "    nobody:\n"
      "  plain: viewer\n"
      "mapping:\n"
      "  discrete_inputs: {door: 0}\n"
      "  coils: {valve_1: 2, lamp: 0, siren: {address: 3, access: write}}\n");
  const Map& map = owned->map();
  ASSERT_EQ(map.security.roles.size(), 3U);
  const auto granted = [&](std::size_t role, Right right) {
    std::string names;
    for (std::size_t i = 0; i < map.points.size(); ++i)
      if (map.security.roles[role].may(right, i)) names += std::string(map.points[i].name) + ' ';
    return names;
  };
  EXPECT_EQ(granted(0, Right::read), "lamp valve_1 siren door ") << "all is all, though siren cannot be read";
  EXPECT_EQ(granted(0, Right::write), "lamp valve_1 ");
  EXPECT_EQ(granted(1, Right::read), "lamp door ");
  EXPECT_EQ(granted(2, Right::read) + granted(1, Right::write), "");
  EXPECT_TRUE(map.security.roles[0].reads_all);
  EXPECT_FALSE(map.security.roles[1].reads_all);
  ASSERT_TRUE(map.security.plain);
  EXPECT_EQ(map.security.roles[*map.security.plain].name, "viewer");
}

TEST(Security, With_certificates_it_has_all_that_TLS_needs) {
  const MapPtr owned = test::load_clean(
      "name: cell\n"
      "security:\n"
      "  certificate: press.pem\n"
      "  key: press.key\n"
      "  ca: authority.pem\n"
      "  no_role: viewer\n"
      "  roles: {viewer: {read: all}}\n"
      "mapping:\n"
      "  coils: {lamp: 0}\n");
  const Security& security = owned->map().security;
  EXPECT_EQ(security.files.certificate, "press.pem");
  EXPECT_EQ(security.files.key, "press.key");
  EXPECT_EQ(security.files.ca, "authority.pem");
  EXPECT_EQ(security.port, 802);
  ASSERT_NE(security.role_of("unheard of"), nullptr);
  EXPECT_EQ(security.role_of("unheard of")->name, "viewer");
  EXPECT_FALSE(security.plain);
}

TEST(Connection, With_TLS_has_port_802) {
  const char* tls = "tls: {certificate: cell1.pem, key: cell1.key, ca: authority.pem}";
  const MapPtr owned = test::load_with(tls);
  EXPECT_EQ(owned->map().connection.port, 802);
  EXPECT_EQ(owned->map().connection.tls.key, "cell1.key");
  EXPECT_EQ(owned->map().service.port, 502);
  EXPECT_EQ(test::load_with(std::string("port: 1802\n") + tls)->map().connection.port, 1802);
}

TEST(Service, A_map_of_both_ends_has_the_ports_of_both) {
  const MapPtr owned = test::load_with(
      "port: 1502\ntls: {certificate: cell1.pem, key: cell1.key, ca: authority.pem, port: 1802}");
  ASSERT_NE(owned, nullptr);
  EXPECT_EQ(owned->map().connection.port, 1802);
  EXPECT_EQ(owned->map().service.port, 1502);
}

TEST(Security, Without_plain_clients_may_do_nothing) {
  const MapPtr owned = test::load_with("security: {roles: {operator: {read: all}}}");
  EXPECT_TRUE(owned->map().security.present());
  EXPECT_FALSE(owned->map().security.plain);
}

// Each has rights for every point, and its index has 16 bits.
TEST(Security, Has_at_most_a_hundred_roles) {
  const auto with = [](int count) {
    std::string text = "name: cell\nsecurity:\n  roles:\n";
    for (int i = 0; i < count; ++i) text += "    r" + std::to_string(i) + ": {read: all}\n";
    return load_map(text + "mapping: {coils: {lamp: 0}}\n", "cell");
  };
  EXPECT_TRUE(with(100).map);
  const LoadResult many = with(101);
  EXPECT_FALSE(many.map);
  ASSERT_EQ(many.diagnostics.size(), 1U);
  EXPECT_EQ(many.diagnostics[0].what, "there are 101 roles, and a map has at most 100");
}

TEST(Security, That_of_a_served_map_is_the_nodes_own) {
  const LoadResult loaded = load_served_map(
      "{name: cell, security: {roles: {operator: {certificate: any}}}, mapping: {coils: {lamp: 0}}}", "cell");
  ASSERT_TRUE(loaded.map);
  EXPECT_FALSE(loaded.map->map().security.present());
}

}  // namespace
}  // namespace coupler
