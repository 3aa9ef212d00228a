// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/place_check.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

Map at_an_address() {
  Map map;
  map.connection.address = "10.0.0.7";
  return map;
}

Map on_a_line() {
  Map map;
  map.connection.serial.device = "/dev/ttyUSB0";
  return map;
}

TEST(PlaceCheck, What_a_serial_port_needs_does_nothing_at_an_address) {
  Settings settings;
  settings.baud = 9600;
  EXPECT_THAT(useless_setting(settings, at_an_address()),
              StartsWith("baud has no meaning at 10.0.0.7 port 502"));
  EXPECT_THAT(useless_setting(settings, on_a_line()), IsEmpty());
  settings.serial = "/dev/ttyS1";
  EXPECT_THAT(useless_setting(settings, at_an_address()), IsEmpty()) << "it is on a line then";
}

TEST(PlaceCheck, A_port_does_nothing_on_a_serial_line) {
  Settings settings;
  settings.port = 1502;
  EXPECT_THAT(useless_setting(settings, on_a_line()), HasSubstr("on the serial port /dev/ttyUSB0"));
  EXPECT_THAT(useless_setting(settings, at_an_address()), IsEmpty());
  settings.address = "gateway";
  EXPECT_THAT(useless_setting(settings, on_a_line()), IsEmpty()) << "it is at an address then";
}

TEST(PlaceCheck, TLS_needs_all_of_its_files) {
  Settings settings;
  settings.certificate = "/cell1.pem";
  Map map = at_an_address();
  apply(settings, map);
  EXPECT_THAT(place_error(settings, map.connection), HasSubstr("TLS needs key"));
  settings.key = "/cell1.key";
  apply(settings, map);
  EXPECT_THAT(place_error(settings, map.connection), HasSubstr("TLS needs ca (or pin)"));
  settings.ca = "/authority.pem";
  apply(settings, map);
  EXPECT_THAT(place_error(settings, map.connection), IsEmpty());
  map.connection.framing = Framing::rtu;
  EXPECT_THAT(place_error(settings, map.connection), HasSubstr("RTU has no TLS"));
}

TEST(PlaceCheck, A_name_for_TLS_does_nothing_without_it) {
  Settings settings;
  settings.tls_name = "press";
  EXPECT_THAT(useless_setting(settings, at_an_address()), HasSubstr("tls_name has no meaning without TLS"));
}

TEST(PlaceCheck, What_a_driver_shows_of_its_device_may_be_given_to_it) {
  for (const Map& map : {at_an_address(), on_a_line()}) {
    Settings shown = with_map({}, map);
    if (map.connection.address.empty()) shown.address.reset();
    if (!map.connection.serial.present()) shown.serial.reset();
    EXPECT_THAT(useless_setting(shown, map), IsEmpty());
    EXPECT_THAT(place_error(shown, map.connection), IsEmpty());
  }
}

TEST(PlaceCheck, A_device_is_at_one_place) {
  Settings settings;
  settings.address = "10.0.0.7";
  settings.serial = "/dev/ttyUSB0";
  EXPECT_THAT(place_error(settings, at_an_address().connection), HasSubstr("give one of them"));
}

}  // namespace
}  // namespace coupler::host
