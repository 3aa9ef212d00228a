// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/net/allow_list.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

AllowList allow(std::initializer_list<const char*> ranges) {
  std::vector<Network> networks;
  for (const char* range : ranges) {
    const auto network = parse_network(range);
    EXPECT_TRUE(network.has_value()) << range;
    if (network) networks.push_back(*network);
  }
  return AllowList(networks);
}

TEST(AllowList, Without_names_it_admits_everyone) {
  EXPECT_TRUE(AllowList().admits(ipv4("192.0.2.1")));
  EXPECT_TRUE(AllowList().admits(ipv6("2001:db8::1")));
}

TEST(AllowList, One_of_its_ranges_is_enough) {
  const AllowList list = allow({"10.0.0.7", "192.168.0.0/24", "fd00::/8"});
  EXPECT_TRUE(list.admits(ipv4("10.0.0.7")));
  EXPECT_TRUE(list.admits(ipv4("192.168.0.200")));
  EXPECT_TRUE(list.admits(ipv6("fd12::1")));
  EXPECT_FALSE(list.admits(ipv4("10.0.0.8")));
  EXPECT_FALSE(list.admits(ipv6("fe80::1")));
}

TEST(AllowList, A_socket_of_both_families_shows_IPv4_as_IPv6) {
  EXPECT_TRUE(allow({"10.0.0.0/8"}).admits(ipv6("::ffff:10.1.2.3")));
  EXPECT_FALSE(allow({"10.0.0.0/8"}).admits(ipv6("::ffff:11.1.2.3")));
}

TEST(AllowList, All_of_IPv6_is_nobody_of_IPv4_and_the_other_way_round) {
  EXPECT_TRUE(allow({"::/0"}).admits(ipv6("2001:db8::1")));
  EXPECT_FALSE(allow({"::/0"}).admits(ipv6("::ffff:10.1.2.3")));
  EXPECT_FALSE(allow({"::/0"}).admits(ipv4("10.1.2.3")));
  EXPECT_TRUE(allow({"0.0.0.0/0"}).admits(ipv6("::ffff:10.1.2.3")));
  EXPECT_FALSE(allow({"0.0.0.0/0"}).admits(ipv6("2001:db8::1")));
}

TEST(AllowList, What_is_no_address_in_allow_is_named) {
  constexpr std::string_view allow[] = {"10.0.0.7", "gripper"};
  Map map;
  map.service.allow = allow;
  const auto list = AllowList::of(map);
  ASSERT_FALSE(list.has_value());
  EXPECT_THAT(list.error(), HasSubstr("'allow': 'gripper' is not an IP address"));
  map.service.allow = Span<const std::string_view>(allow).first(1);
  EXPECT_TRUE(AllowList::of(map).has_value());
}

TEST(Accepting, Who_is_not_on_the_list_is_closed_at_once_counted_and_named_once) {
  TcpUnderTest server(8, allow({"192.0.2.0/24"}));
  Client first = server.connect();
  Client second = server.connect();
  EXPECT_TRUE(first.is_closed());
  EXPECT_TRUE(second.is_closed());
  EXPECT_EQ(server.tcp.size(), 0U);
  EXPECT_EQ(server.node.statistics.refusals, 2U);
  EXPECT_EQ(server.node.statistics.connections, 0U);
  EXPECT_THAT(server.log.lines, ElementsAre(HasSubstr("127.0.0.1 may not connect")));
}

TEST(Accepting, Who_is_on_the_list_is_served) {
  TcpUnderTest server(8, allow({"127.0.0.0/8"}));
  Client client = server.connect();
  client.send(question(1));
  server.settle();
  EXPECT_EQ(client.received(), answer_to(1));
}

}  // namespace
}  // namespace coupler::device
