// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/place_argument.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace coupler::tools {
namespace {

using testing::HasSubstr;

TEST(PlaceArgument, What_names_a_device_can_be_one) {
  for (const char* argument :
       {"press", "press.local", "192.168.1.20", "192.168.1.20:1502", "192.168.1.20:1502/7", "press/7",
        "[fd00::7]:1502", "tcp://press", "tls://press", "rtu+tcp://press:4001/3",
        "rtu:/dev/ttyUSB0/17?baud=9600", "tcp://press.yaml", "/dev/ttyUSB77", "/dev/ttyUSB77/17", "cell:0"})
    EXPECT_TRUE(can_be_a_device(argument)) << argument;
}

TEST(PlaceArgument, What_names_a_file_cannot) {
  for (const char* argument : {"", "-", "press.yaml", "press.yml", "press.json", "./press", "maps/press",
                               "/tmp/press", "main:maps/cell.yaml", "/dev/null", "."})
    EXPECT_FALSE(can_be_a_device(argument)) << argument;
}

TEST(PlaceArgument, A_file_that_is_there_is_no_device) {
  const std::string file = testing::TempDir() + "place_argument_1502";
  std::ofstream(file) << "name: press\n";
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(testing::TempDir());
  EXPECT_FALSE(can_be_a_device("place_argument_1502"));
  EXPECT_TRUE(can_be_a_device("tcp://place_argument_1502"));
  std::filesystem::current_path(before);
  std::filesystem::remove(file);
  EXPECT_TRUE(can_be_a_device("place_argument_1502"));
}

TEST(PlaceArgument, Where_only_a_device_can_stand_a_map_is_refused) {
  const TlsTexts tls;
  for (const char* argument : {"-", "press.yaml", "maps/press.json"}) {
    const auto place = get_place(argument, tls);
    ASSERT_FALSE(place) << argument;
    EXPECT_EQ(place.error().exit, bad_call);
    EXPECT_THAT(place.error().what, HasSubstr(" is a map, and this asks a device"));
  }
  EXPECT_EQ(get_place("press:1502/7", tls)->connection.port, 1502);
  EXPECT_EQ(get_place("press:1502/7", tls)->connection.unit, 7);
  EXPECT_EQ(get_place("/dev/ttyUSB77/17", tls)->connection.serial.device, "/dev/ttyUSB77");
}

TEST(PlaceArgument, Certificates_belong_to_a_place_with_tls) {
  TlsTexts tls;
  EXPECT_THAT(get_place("tls://press", tls).error().remedy,
              HasSubstr("give --certificate FILE and --key FILE"));
  tls.pin = "sha256:" + std::string(64, '0');
  EXPECT_THAT(get_place("press", tls).error().remedy, HasSubstr("write tls:// before the host"));
  tls.certificate = "cell.pem";
  tls.key = "cell.key";
  EXPECT_EQ(get_place("tls://press", tls)->connection.tls.key, "cell.key");
}

TEST(PlaceArgument, A_place_is_written_as_a_shell_takes_it) {
  EXPECT_EQ(as_argument("tcp://press:502/1"), "press:502/1");
  EXPECT_EQ(as_argument("tls://press:802/1"), "tls://press:802/1");
  EXPECT_EQ(as_argument("rtu:/dev/ttyUSB0/17?baud=9600&parity=none"),
            "'rtu:/dev/ttyUSB0/17?baud=9600&parity=none'");
}

TEST(PlaceArgument, Where_a_device_has_answered_has_the_settings_of_its_line) {
  const TlsTexts tls;
  const auto line = get_place("rtu:/dev/ttyUSB0/17?baud=9600&parity=none", tls);
  EXPECT_EQ(as_argument(line->connection), "'rtu:/dev/ttyUSB0/17?baud=9600&parity=none&stop_bits=1'");
  EXPECT_EQ(get_place("rtu:/dev/ttyUSB0/17?baud=9600&parity=none&stop_bits=1", tls)->connection.serial.baud,
            9600U);
  EXPECT_EQ(as_argument(get_place("press", tls)->connection), "press:502/1");
}

}  // namespace
}  // namespace coupler::tools
