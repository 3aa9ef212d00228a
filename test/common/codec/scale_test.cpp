// SPDX-License-Identifier: Apache-2.0
// Scaling against test/golden/scale.json, whose numbers come from Python.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/type_name.hpp"
#include "test/support/paths.hpp"

namespace coupler::codec {
namespace {

using nlohmann::json;

double number(const json& c, const char* key) {
  return std::strtod(c.at(key).get<std::string>().c_str(), nullptr);
}

Format numeric_format(const json& c) {
  Format format;
  format.type = parse_type(c.at("type").get<std::string>()).value();
  return format;
}

ScaleError error_of(const json& c) {
  if (!c.contains("error")) return ScaleError::none;
  return c.at("error") == "not_a_number" ? ScaleError::not_a_number : ScaleError::out_of_range;
}

class GoldenScale : public testing::Test {
 protected:
  GoldenScale() {
    std::ifstream file(test::in_tree("test/golden/scale.json"));
    cases_ = json::parse(file);
  }
  json cases_;
};

TEST_F(GoldenScale, A_published_value_becomes_the_nearest_registers_or_is_refused) {
  for (const json& c : cases_) {
    SCOPED_TRACE(c.dump());
    const Format format = numeric_format(c);
    const Scale scale{number(c, "gain"), number(c, "offset")};
    std::vector<std::uint16_t> written(registers(format), 0xAAAA);
    const std::vector<std::uint16_t> before = written;
    ASSERT_EQ(encode_published(number(c, "value"), format, scale, written.data()), error_of(c));
    EXPECT_EQ(written, c.contains("error") ? before : c.at("registers").get<std::vector<std::uint16_t>>());
  }
}

TEST_F(GoldenScale, Registers_are_published_as_raw_times_gain_plus_offset) {
  for (const json& c : cases_) {
    if (c.contains("error")) continue;
    SCOPED_TRACE(c.dump());
    const auto raw = c.at("registers").get<std::vector<std::uint16_t>>();
    const Scale scale{number(c, "gain"), number(c, "offset")};
    EXPECT_EQ(published(raw.data(), numeric_format(c), scale), number(c, "published"));
  }
}

Format int16() {
  Format format;
  format.type = Type::INT;
  return format;
}

TEST(Scale, A_measurement_beyond_the_range_becomes_its_end) {
  std::uint16_t written = 0;
  encode_nearest(1e9, int16(), {0.1, 0}, &written);
  EXPECT_EQ(written, 0x7FFF);
  encode_nearest(-1e9, int16(), {0.1, 0}, &written);
  EXPECT_EQ(written, 0x8000);
  encode_nearest(1e9, int16(), {-0.1, 0}, &written);
  EXPECT_EQ(written, 0x8000);
  encode_nearest(std::numeric_limits<double>::infinity(), int16(), {0.1, 0}, &written);
  EXPECT_EQ(written, 0x7FFF);
}

TEST(Scale, The_published_range_has_the_smaller_end_first) {
  EXPECT_EQ(published_range({Type::SINT}, {1, 0}).least, -128);
  EXPECT_EQ(published_range({Type::USINT}, {-2, 10}).least, -500);
  EXPECT_EQ(published_range({Type::USINT}, {-2, 10}).most, 10);
}

TEST(Scale, The_other_byte_of_a_register_stays) {
  Format format;
  format.type = Type::SINT;
  format.half = Half::low;
  std::uint16_t shared = 0xAB00;
  ASSERT_EQ(encode_published(-6.3, format, {0.1, 0}, &shared), ScaleError::none);
  EXPECT_EQ(shared, 0xABC1);
  EXPECT_DOUBLE_EQ(published(&shared, format, {0.1, 0}), -6.3);
}

TEST(Scale, Numbers_can_be_scaled_bits_and_texts_cannot) {
  for (const Type type : {Type::SINT, Type::ULINT, Type::REAL, Type::LREAL}) EXPECT_TRUE(is_scalable(type));
  for (const Type type : {Type::BOOL, Type::BYTE, Type::LWORD, Type::CHAR, Type::STRING})
    EXPECT_FALSE(is_scalable(type));
}

}  // namespace
}  // namespace coupler::codec
