// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/device/net/client_address.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

TEST(Origin, IPv4_in_either_form_is_one_and_each_address_is_another) {
  EXPECT_EQ(origin_of(ipv4("10.0.0.7")), origin_of(ipv6("::ffff:10.0.0.7")));
  EXPECT_NE(origin_of(ipv4("10.0.0.7")), origin_of(ipv4("10.0.0.8")));
}

TEST(Origin, Of_IPv6_it_is_the_network_of_64_bits) {
  EXPECT_EQ(origin_of(ipv6("fd00:1:2:3::7")), origin_of(ipv6("fd00:1:2:3:ffff::8")));
  EXPECT_NE(origin_of(ipv6("fd00:1:2:3::7")), origin_of(ipv6("fd00:1:2:4::7")));
  EXPECT_NE(origin_of(ipv6("::1")), origin_of(ipv4("0.0.0.1")));
}

}  // namespace
}  // namespace coupler::device
