// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/dump_output.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "test/fakes/map_builder.hpp"

namespace coupler::tools {
namespace {

using codec::Type;
using fakes::MapBuilder;
using nlohmann::json;
using State = Reading::State;

json value_of(Type type, std::vector<std::uint16_t> registers, std::uint16_t count = 1) {
  const MapPtr map = MapBuilder()
                         .add(Table::holding_registers, "a", 0, type,
                              [&](Point& point) {
                                point.count = count;
                                point.format.length = 4;
                              })
                         .build();
  Snapshot now;
  now.readings = {{0, State::good, std::move(registers)}};
  return json::parse(dump_json(map->map(), now))["points"][0]["value"];
}

TEST(DumpJson, Values_have_the_types_of_json) {
  EXPECT_EQ(value_of(Type::INT, {0xFFFE}), -2);
  EXPECT_EQ(value_of(Type::LWORD, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF}), 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(value_of(Type::BOOL, {1}), true);
  EXPECT_EQ(value_of(Type::STRING, {0x4142, 0x4344}), "ABCD");
  EXPECT_EQ(value_of(Type::INT, {1, 2, 3}, 3), (json{1, 2, 3}));
}

TEST(DumpJson, A_REAL_has_the_digits_that_it_can_tell_apart) {
  EXPECT_EQ(value_of(Type::REAL, {0x3DCC, 0xCCCD}).dump(), "0.1");
}

TEST(DumpJson, A_scaled_value_is_the_number_of_its_text) {
  const MapPtr map = MapBuilder()
                         .add(Table::holding_registers, "a", 0, Type::INT,
                              [](Point& point) {
                                point.count = 2;
                                point.scale.gain = 0.1;
                              })
                         .build();
  Snapshot now;
  now.readings = {{0, State::good, {217, 5}}};
  EXPECT_EQ(json::parse(dump_json(map->map(), now))["points"][0]["value"].dump(), "[21.7,0.5]");
}

TEST(DumpJson, What_no_number_of_json_can_be_is_null_and_has_its_text) {
  EXPECT_EQ(value_of(Type::REAL, {0x7FC0, 0}), nullptr);
  const MapPtr map = MapBuilder().add(Table::holding_registers, "a", 0, Type::REAL).build();
  Snapshot now;
  now.readings = {{0, State::good, {0x7F80, 0}}};
  EXPECT_EQ(json::parse(dump_json(map->map(), now))["points"][0]["text"], "inf");
}

TEST(DumpJson, A_point_without_a_value_says_why) {
  const MapPtr map = MapBuilder().many(Table::coils, 0, 2).build();
  Snapshot now;
  now.readings = {{0, State::failed, {}, "exception 02 (…)", modbus::Exception::illegal_data_address},
                  {1, State::not_asked, {}, "write-only"}};
  const json points = json::parse(dump_json(map->map(), now))["points"];
  EXPECT_EQ(points[0]["value"], nullptr);
  EXPECT_EQ(points[0]["exception"], 2);
  EXPECT_EQ(points[0]["failed"], true);
  EXPECT_EQ(points[1]["failed"], false);
  EXPECT_EQ(points[1]["why"], "write-only");
}

TEST(DumpJson, It_is_one_line_that_says_whether_the_device_answers) {
  MapBuilder builder("press");
  builder.head().connection.address = "::1";
  const MapPtr map = builder.build();
  Snapshot now;
  now.notes = {"one\ntwo"};
  std::string text = dump_json(map->map(), now);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(json::parse(text)["online"], true);
  EXPECT_EQ(json::parse(text)["trouble"], nullptr);
  EXPECT_EQ(json::parse(text)["device"], "tcp://[::1]:502/1");
  now.error = host::NotConnected{"refused"};
  EXPECT_EQ(json::parse(dump_json(map->map(), now))["online"], false);
  EXPECT_EQ(json::parse(dump_json(map->map(), now))["trouble"], "refused");
}

}  // namespace
}  // namespace coupler::tools
