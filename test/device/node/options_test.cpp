// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "coupler/device/node/options.hpp"

namespace coupler::device {
namespace {

using testing::HasSubstr;

std::variant<Options, int> parse(std::vector<std::string> arguments, MapSource source = MapSource::argument) {
  arguments.insert(arguments.begin(), "/usr/bin/coupler-node");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return parse_options(static_cast<int>(argv.size()), argv.data(), source);
}

int status(std::vector<std::string> arguments, MapSource source = MapSource::argument) {
  const auto parsed = parse(std::move(arguments), source);
  return std::holds_alternative<int>(parsed) ? std::get<int>(parsed) : -1;
}

TEST(NodeOptions, They_are_read) {
  const auto parsed =
      parse({"device.yaml", "--listen", "127.0.0.1", "--port", "1502", "--sim", "--realtime"});
  ASSERT_TRUE(std::holds_alternative<Options>(parsed));
  const auto& options = std::get<Options>(parsed);
  EXPECT_EQ(options.map, "device.yaml");
  EXPECT_EQ(options.listen, "127.0.0.1");
  EXPECT_EQ(options.port, 1502);
  EXPECT_TRUE(options.simulated);
  EXPECT_TRUE(options.realtime);
}

TEST(NodeOptions, The_address_is_the_options_then_the_maps_then_loopback_when_simulated) {
  Map map;
  Options options;
  EXPECT_EQ(address_for(map, options), "");
  options.simulated = true;
  EXPECT_EQ(address_for(map, options), "127.0.0.1");
  map.service.listen = "10.0.0.7";
  EXPECT_EQ(address_for(map, options), "10.0.0.7");
  options.listen = "::1";
  EXPECT_EQ(address_for(map, options), "::1");
}

TEST(NodeOptions, Without_them_the_map_decides) {
  const auto parsed = parse({}, MapSource::built_in);
  ASSERT_TRUE(std::holds_alternative<Options>(parsed));
  const auto& options = std::get<Options>(parsed);
  EXPECT_EQ(options.port, std::nullopt);
  EXPECT_EQ(options.listen, "");
  EXPECT_FALSE(options.simulated);
  EXPECT_FALSE(options.realtime);
}

TEST(NodeOptions, A_wrong_call_is_status_2) {
  EXPECT_EQ(status({}), 2) << "no map";
  EXPECT_EQ(status({"a.yaml", "b.yaml"}), 2);
  EXPECT_EQ(status({"a.yaml"}, MapSource::built_in), 2);
  EXPECT_EQ(status({"a.yaml", "--nonsense"}), 2);
  EXPECT_EQ(status({"a.yaml", "--port"}), 2);
  EXPECT_EQ(status({"a.yaml", "--port", "65536"}), 2);
  EXPECT_EQ(status({"a.yaml", "--port", "-1"}), 2);
}

TEST(NodeOptions, Help_is_status_0_and_shows_an_example) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(status({"--help"}), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("coupler-node device.yaml --sim --port 1502"));
}

}  // namespace
}  // namespace coupler::device
