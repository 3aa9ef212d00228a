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

TEST(Settings, A_serial_port_takes_the_place_of_an_address) {
  Map map;
  map.connection.address = "cell";
  Settings settings;
  ASSERT_TRUE(set(settings, "serial", "/dev/ttyUSB0"));
  ASSERT_TRUE(set(settings, "baud", "9600"));
  ASSERT_TRUE(set(settings, "parity", "none"));
  ASSERT_TRUE(set(settings, "stop_bits", "2"));
  ASSERT_TRUE(set(settings, "rs485", "true"));
  apply(settings, map);
  EXPECT_EQ(map.connection.address, "");
  EXPECT_EQ(map.connection.serial, (Serial{"/dev/ttyUSB0", 9600, Serial::Parity::none, 2, true}));
  for (const auto* const key : {"serial", "baud", "parity", "stop_bits", "rs485"}) {
    Settings again;
    ASSERT_TRUE(set(again, key, *text_of(settings, key))) << key;
  }
}

TEST(Settings, An_address_takes_the_place_of_a_serial_port) {
  Map map;
  map.connection.serial.device = "/dev/ttyUSB0";
  Settings settings;
  settings.address = "cell";
  apply(settings, map);
  EXPECT_EQ(map.connection.address, "cell");
  EXPECT_FALSE(map.connection.is_rtu());
}

TEST(Settings, An_address_means_modbus_tcp_unless_a_framing_is_given) {
  Map map;
  map.connection.address = "gateway";
  map.connection.framing = Framing::rtu;
  Settings settings;
  settings.address = "cell";
  Map moved = map;
  apply(settings, moved);
  EXPECT_FALSE(moved.connection.is_rtu());
  settings.framing = Framing::rtu;
  apply(settings, map);
  EXPECT_TRUE(map.connection.is_rtu());
}

TEST(Settings, The_stronger_side_says_the_whole_way_to_the_device) {
  Settings parameters;
  parameters.address = "cell";
  Settings arguments;
  arguments.serial = "/dev/ttyUSB0";
  EXPECT_FALSE(overlay(parameters, arguments).address);
  EXPECT_FALSE(overlay(arguments, parameters).serial);
}

TEST(Settings, What_belongs_to_a_place_goes_with_it) {
  Settings at_an_address;
  at_an_address.address = "cell";
  at_an_address.port = 1502;
  at_an_address.framing = Framing::rtu;
  Settings on_a_line;
  on_a_line.serial = "/dev/ttyUSB0";
  on_a_line.baud = 9600;
  on_a_line.parity = Serial::Parity::none;
  on_a_line.stop_bits = 2;
  on_a_line.rs485 = true;
  const Settings line = overlay(at_an_address, on_a_line);
  EXPECT_FALSE(line.port || line.framing);
  EXPECT_EQ(line.baud, 9600U);
  const Settings address = overlay(on_a_line, at_an_address);
  EXPECT_FALSE(address.baud || address.parity || address.stop_bits || address.rs485);
  EXPECT_EQ(address.port, 1502);
}

TEST(Settings, Settings_that_a_serial_port_cannot_have_are_refused) {
  const std::pair<const char*, const char*> cases[] = {{"baud", "9601"},     {"parity", "N"},
                                                       {"stop_bits", "3"},   {"rs485", "maybe"},
                                                       {"framing", "ascii"}, {"serial", ""}};
  for (const auto& [key, text] : cases) {
    Settings settings;
    const auto done = set(settings, key, text);
    ASSERT_FALSE(done) << key;
    EXPECT_EQ(done.error().rfind(key, 0), 0U) << done.error();
  }
}

TEST(Settings, Certificates_make_a_connection_one_with_TLS) {
  Settings settings;
  ASSERT_TRUE(set(settings, "certificate", "cell1.pem"));
  ASSERT_TRUE(set(settings, "key", "/keys/cell1.key"));
  ASSERT_TRUE(set(settings, "ca", "authority.pem"));
  Map map;
  apply(settings, map);
  EXPECT_EQ(map.connection.port, 802) << "the map has none";
  EXPECT_EQ(map.connection.tls.key, "/keys/cell1.key");
  EXPECT_EQ(map.connection.tls.certificate.front(), '/')
      << "it begins in the working directory, not beside the map";
  Map elsewhere;
  elsewhere.connection.port = 1802;
  apply(settings, elsewhere);
  EXPECT_EQ(elsewhere.connection.port, 1802);
}

TEST(Settings, A_pin_takes_the_place_of_an_authority_and_the_other_way_round) {
  const std::string pin = "sha256:" + std::string(64, 'a');
  Map map;
  map.connection.tls = {"cell1.pem", "cell1.key", "authority.pem", "", "", ""};
  Settings pinned;
  ASSERT_TRUE(set(pinned, "pin", pin));
  apply(pinned, map);
  EXPECT_EQ(map.connection.tls.ca, "");
  EXPECT_EQ(map.connection.tls.pin, pin);
  Settings believing;
  ASSERT_TRUE(set(believing, "ca", "other.pem"));
  apply(believing, map);
  EXPECT_EQ(map.connection.tls.pin, "");
  EXPECT_FALSE(set(pinned, "pin", "sha1:00"));
}

TEST(Settings, A_serial_port_has_no_TLS) {
  Map map;
  map.connection.tls = {"cell1.pem", "cell1.key", "authority.pem", "", "", ""};
  Settings settings;
  settings.serial = "/dev/ttyUSB0";
  apply(settings, map);
  EXPECT_FALSE(map.connection.tls.present());
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
