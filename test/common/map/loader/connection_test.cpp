// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;

TEST(SerialConnection, Its_defaults_are_those_of_the_specification) {
  const MapPtr map = test::load_with("serial: {device: /dev/ttyUSB0}");
  const Connection& connection = map->map().connection;
  EXPECT_EQ(connection.serial, (Serial{"/dev/ttyUSB0", 19200, Serial::Parity::even, 1, false}));
  EXPECT_TRUE(connection.is_rtu());
  EXPECT_EQ(connection.timeout, 500ms);
}

TEST(SerialConnection, All_settings_are_read) {
  const MapPtr map = test::load_with(
      "serial: {device: /dev/ttyS1, baud: 9600, parity: none, stop_bits: 2, rs485: true}\nunit: 17\ntimeout: "
      "1s");
  const Connection& connection = map->map().connection;
  EXPECT_EQ(connection.serial, (Serial{"/dev/ttyS1", 9600, Serial::Parity::none, 2, true}));
  EXPECT_EQ(connection.unit, 17);
  EXPECT_EQ(connection.timeout, 1s);
}

TEST(SerialConnection, Rtu_may_go_over_tcp) {
  const MapPtr map = test::load_with("address: gateway\nport: 4001\nframing: rtu");
  const Connection& connection = map->map().connection;
  EXPECT_TRUE(connection.is_rtu());
  EXPECT_FALSE(connection.serial.present());
  EXPECT_EQ(connection.timeout, 500ms);
  EXPECT_FALSE(test::load_with("address: gateway\nframing: tcp")->map().connection.is_rtu());
}

}  // namespace
}  // namespace coupler
