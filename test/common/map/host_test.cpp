// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/host.hpp"

#include <gtest/gtest.h>

namespace coupler {
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
  EXPECT_EQ(told("10.0.0.7:1502"), "has a port; say 'port: 1502' beside it");
  EXPECT_EQ(told("plc:502"), "has a port; say 'port: 502' beside it");
  EXPECT_EQ(told("[::1]:502"), "has a port; say 'port: 502' beside it");
  for (const char* text : {"192.168.1.300", "10.0.0", "1.2.3.4.5", "7"})
    EXPECT_EQ(told(text), "is not an IP address; write four numbers from 0 to 255, as in 192.168.0.10")
        << text;
  for (const char* text : {"", "fd00::g", "the press", "-plc", "[plc]", "[10.0.0.7]", "plc/1", "a:b"})
    EXPECT_FALSE(parse_host(text)) << text;
}

}  // namespace
}  // namespace coupler
