// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/scalar.hpp"

#include <gtest/gtest.h>

namespace coupler::loader {
namespace {

using namespace std::chrono_literals;

TEST(Scalar, A_number_with_leading_zeros_is_decimal) {
  EXPECT_EQ(parse_unsigned("00010"), 10U);
  EXPECT_EQ(parse_unsigned("0"), 0U);
  EXPECT_EQ(parse_integer("-007"), -7);
}

TEST(Scalar, Hexadecimal_needs_its_prefix) {
  EXPECT_EQ(parse_unsigned("0xFf00"), 0xFF00U);
  EXPECT_EQ(parse_unsigned("0X10"), 16U);
  EXPECT_EQ(parse_unsigned("FF"), std::nullopt);
  EXPECT_EQ(parse_unsigned("0x"), std::nullopt);
}

TEST(Scalar, What_is_not_wholly_a_number_is_none) {
  for (const char* text :
       {"", " 1", "1 ", "+1", "1_000", "1.0", "1e3", "0o17", "0b1", "--1", "18446744073709551616"}) {
    EXPECT_EQ(parse_unsigned(text), std::nullopt) << text;
    EXPECT_EQ(parse_integer(text), std::nullopt) << text;
  }
  EXPECT_EQ(parse_integer("9223372036854775808"), std::nullopt);
  EXPECT_EQ(parse_unsigned("18446744073709551615"), 18446744073709551615U);
}

TEST(Scalar, Numbers_are_finite_and_decimal) {
  EXPECT_EQ(parse_number("-0.5"), -0.5);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("1e3"), 1000);
  for (const char* text : {"", "-", ".", "nan", "inf", "-inf", ".inf", "1e999", "1,5", "0x10", "5 "})
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(Scalar, Booleans_are_those_of_yaml_1_1) {
  for (const char* text : {"true", "True", "TRUE", "yes", "on", "ON"})
    EXPECT_EQ(parse_boolean(text), true) << text;
  for (const char* text : {"false", "no", "off", "Off"}) EXPECT_EQ(parse_boolean(text), false) << text;
  for (const char* text : {"", "1", "y", "truth", "offline"})
    EXPECT_EQ(parse_boolean(text), std::nullopt) << text;
}

TEST(Scalar, A_duration_needs_its_unit) {
  EXPECT_EQ(parse_duration("5ms"), 5ms);
  EXPECT_EQ(parse_duration("500us"), 500us);
  EXPECT_EQ(parse_duration("1.5s"), 1500ms);
  EXPECT_EQ(parse_duration("2min"), 120s);
  EXPECT_EQ(parse_duration("0"), 0us);
  for (const char* text : {"", "5", "ms", "5 ms", "-5ms", "5h", "5MS", "24000min", "1e400s", "ms5"})
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
}

}  // namespace
}  // namespace coupler::loader
