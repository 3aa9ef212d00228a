// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coupler/host/record/record_format.hpp"
#include "coupler/host/record/value_json.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/record/record_moment.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using test::some_moment;

const std::string json_when = R"({"t":1.500000,"utc":"2026-11-21T13:20:11.123Z",)";

template <class Adjust>
std::string json_of(Type type, const std::vector<std::uint16_t>& registers, Adjust adjust) {
  const MapPtr map = MapBuilder().add(Table::holding_registers, "level", 0, type, adjust).build();
  return value_json(registers.data(), map->map().points[0]).dump();
}
std::string json_of(Type type, const std::vector<std::uint16_t>& registers) {
  return json_of(type, registers, [](Point&) {});
}

TEST(ValueJson, Numbers_have_the_digits_of_their_type) {
  EXPECT_EQ(json_of(Type::REAL, {0x3DCC, 0xCCCD}), "0.1");
  EXPECT_EQ(json_of(Type::LREAL, {0x3FB9, 0x9999, 0x9999, 0x999A}), "0.1");
  EXPECT_EQ(json_of(Type::LINT, {0x8000, 0, 0, 0}), "-9223372036854775808");
  EXPECT_EQ(json_of(Type::ULINT, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF}), "18446744073709551615");
}

TEST(ValueJson, What_JSON_has_no_number_for_is_null) {
  EXPECT_EQ(json_of(Type::REAL, {0x7FC0, 0}), "null");
  EXPECT_EQ(json_of(Type::REAL, {0x7F80, 0}), "null");
  EXPECT_EQ(json_of(Type::LREAL, {0xFFF0, 0, 0, 0}), "null");
}

TEST(ValueJson, A_scaled_value_has_the_digits_that_were_meant) {
  EXPECT_EQ(json_of(Type::INT, {217}, [](Point& point) { point.scale.gain = 0.1; }), "21.7");
  EXPECT_EQ(json_of(Type::INT, {217, 0xFFFF},
                    [](Point& point) {
                      point.scale.gain = 0.1;
                      point.count = 2;
                    }),
            "[21.7,-0.1]");
}

TEST(ValueJson, A_bit_is_a_boolean_in_a_register_too) {
  EXPECT_EQ(json_of(Type::BOOL, {0x0004}, [](Point& point) { point.format.bit = 2; }), "true");
  EXPECT_EQ(json_of(Type::BOOL, {0x0003}, [](Point& point) { point.format.bit = 2; }), "false");
}

TEST(ValueJson, An_array_is_a_list_of_whole_values) {
  EXPECT_EQ(json_of(Type::REAL, {0x3DCC, 0xCCCD, 0x3F80, 0}, [](Point& point) { point.count = 2; }),
            "[0.1,1.0]");
}

TEST(JsonFormat, A_value_has_its_registers_and_a_bit_has_none) {
  const MapPtr map = MapBuilder().coil("lamp", 0).holding("level", 0, Type::INT).build();
  const std::uint16_t on = 1;
  const std::uint16_t level = 0xFFFB;
  const auto format = json_format();
  EXPECT_EQ(format->value(some_moment(), *find(map->map(), "lamp"), {&on, 1}, std::chrono::milliseconds(1),
                          PointQuality::State::good),
            json_when + R"("point":"lamp","value":true,"quality":"good","u":0.001000})"
                        "\n");
  EXPECT_EQ(
      format->value(some_moment(), *find(map->map(), "level"), {&level, 1}, {}, PointQuality::State::good),
      json_when + R"("point":"level","value":-5,"quality":"good","u":0.000000,"registers":[65531]})"
                  "\n");
}

TEST(JsonFormat, A_text_of_the_device_that_is_not_UTF_8_is_in_the_registers) {
  const MapPtr map = MapBuilder()
                         .add(Table::holding_registers, "text", 0, Type::STRING,
                              [](Point& point) { point.format.length = 2; })
                         .build();
  const std::uint16_t registers = 0x41FF;
  EXPECT_EQ(json_format()->value(some_moment(), map->map().points[0], {&registers, 1}, {},
                                 PointQuality::State::good),
            json_when +
                "\"point\":\"text\",\"value\":\"A\\\\xff\",\"quality\":\"good\",\"u\":0.000000,"
                "\"registers\":[16895]}\n");
}

TEST(JsonFormat, A_point_without_a_value_says_its_quality) {
  const MapPtr map = MapBuilder().holding("level", 0).build();
  EXPECT_EQ(json_format()->no_value(some_moment(), map->map().points[0], PointQuality::State::rejected, 2),
            json_when + R"("point":"level","value":null,"quality":"rejected","exception":2})"
                        "\n");
}

}  // namespace
}  // namespace coupler::host
