// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/map/network.hpp"

namespace coupler {
namespace {

IpAddress address(std::string_view text) {
  const auto network = parse_network(text);
  EXPECT_TRUE(network.has_value()) << text;
  return network ? network->address : IpAddress{};
}

bool contains(std::string_view range, std::string_view other) {
  const auto network = parse_network(range);
  EXPECT_TRUE(network.has_value()) << range;
  return network && network->contains(address(other));
}

TEST(Network, An_address_contains_itself_alone) {
  EXPECT_TRUE(contains("10.0.0.7", "10.0.0.7"));
  EXPECT_FALSE(contains("10.0.0.7", "10.0.0.6"));
  EXPECT_TRUE(contains("fd00::7", "fd00:0::0007"));
  EXPECT_FALSE(contains("fd00::7", "fd00::8"));
}

TEST(Network, A_range_ends_at_its_prefix) {
  EXPECT_TRUE(contains("192.168.4.0/22", "192.168.7.255"));
  EXPECT_FALSE(contains("192.168.4.0/22", "192.168.8.0"));
  EXPECT_TRUE(contains("fe80::/10", "febf::1"));
  EXPECT_FALSE(contains("fe80::/10", "fec0::1"));
}

TEST(Network, Everything_of_one_family_is_not_the_other) {
  EXPECT_TRUE(contains("0.0.0.0/0", "255.255.255.255"));
  EXPECT_FALSE(contains("0.0.0.0/0", "::1"));
  EXPECT_TRUE(contains("::/0", "fd00::7"));
  EXPECT_FALSE(contains("::/0", "10.0.0.7"));
  EXPECT_FALSE(contains("::/8", "::ffff:10.0.0.7"));
  EXPECT_TRUE(contains("::ffff:0:0/96", "10.0.0.7")) << "all of IPv4, as IPv6 writes it";
}

TEST(Network, It_tells_when_it_is_all_of_a_family) {
  EXPECT_TRUE(parse_network("0.0.0.0/0")->is_whole_family());
  EXPECT_TRUE(parse_network("::/0")->is_whole_family());
  for (const char* part : {"0.0.0.0/1", "0.0.0.0", "::/1", "::", "10.0.0.0/8"})
    EXPECT_FALSE(parse_network(part)->is_whole_family()) << part;
}

TEST(Network, A_mapped_address_is_the_IPv4_address) {
  EXPECT_EQ(address("::ffff:10.0.0.7"), address("10.0.0.7"));
}

TEST(Network, Bits_behind_the_prefix_are_refused_with_both_readings) {
  const auto network = parse_network("192.168.0.10/24");
  ASSERT_FALSE(network.has_value());
  EXPECT_EQ(network.error().what, "is an address inside the range 192.168.0.0/24");
  EXPECT_EQ(network.error().remedy,
            "write 192.168.0.0/24 for the range, or 192.168.0.10 for the one address");
  EXPECT_FALSE(parse_network("fd00::7/8").has_value());
}

TEST(Network, What_is_no_address_is_refused) {
  for (const char* text : {"", "/", "10.0.0", "10.0.0.256", "10.0.0.7.1", "gripper", "fd00:::7", "10.0.0.7 ",
                           "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.0/8/8", "fd00::/129", "::/x"})
    EXPECT_FALSE(parse_network(text).has_value()) << text;
}

TEST(Network, One_address_is_neither_a_range_nor_a_name_nor_a_port) {
  for (const char* good : {"127.0.0.1", "0.0.0.0", "::", "::1", "fd00::7", "fe80::7%eth0", "::ffff:10.0.0.7"})
    EXPECT_TRUE(is_ip_address(good)) << good;
  for (const char* bad : {"", "300.1.1.1", "eth0", "localhost", "127.0.0.1:1502", "[::1]", "10.0.0.0/8",
                          "fe80::7%", "%eth0", "10.0.0.7%eth0", " 10.0.0.7"})
    EXPECT_FALSE(is_ip_address(bad)) << bad;
}

}  // namespace

namespace {

TEST(Host, Names_and_addresses_are_taken_and_brackets_left_out) {
  for (const char* text :
       {"plc", "plc-7.cell.local", "my_plc", "10.0.0.7", "fd00::7", "fe80::1%eth0", "7up.example"})
    EXPECT_EQ(parse_host(text).value_or(""), text);
  EXPECT_EQ(parse_host("[::1]").value_or(""), "::1");
  EXPECT_EQ(parse_host("[fe80::1%eth0]").value_or(""), "fe80::1%eth0");
}

TEST(Host, What_is_none_is_told_with_a_remedy) {
  const auto told = [](std::string_view text) {
    const auto host = parse_host(text);
    return host ? "taken" : host.error().what + "; " + host.error().remedy;
  };
  EXPECT_EQ(told("modbus://10.0.0.7"), "has a scheme; leave 'modbus://' out");
  EXPECT_EQ(told("10.0.0.7:1502"), "has a port; write 'port: 1502' beside it");
  EXPECT_EQ(told("plc:502"), "has a port; write 'port: 502' beside it");
  EXPECT_EQ(told("[::1]:502"), "has a port; write 'port: 502' beside it");
  for (const char* text : {"192.168.1.300", "10.0.0", "1.2.3.4.5", "7"})
    EXPECT_EQ(told(text), "is not an IP address; write four numbers from 0 to 255, as in 192.168.0.10")
        << text;
  for (const char* text : {"", "fd00::g", "the press", "-plc", "[plc]", "[10.0.0.7]", "plc/1", "a:b"})
    EXPECT_FALSE(parse_host(text)) << text;
}

}  // namespace
}  // namespace coupler
