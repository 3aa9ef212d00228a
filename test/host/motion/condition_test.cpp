// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/condition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using Words = std::vector<std::uint16_t>;

struct ConditionTest : testing::Test {
  void make(
      Type type, const std::function<void(Point&)>& adjust = [](Point&) {}) {
    owned = MapBuilder().add(Table::holding_registers, "x", 0, type, adjust).build();
  }
  const Point& point() const { return owned->map().points[0]; }
  Condition condition(std::string_view relation, std::string_view value = "") const {
    auto parsed = Condition::parse(point(), relation, value);
    EXPECT_TRUE(parsed) << (parsed ? "" : parsed.error());
    return *parsed;
  }
  std::string error(std::string_view relation, std::string_view value = "") const {
    const auto parsed = Condition::parse(point(), relation, value);
    return parsed ? "" : parsed.error();
  }
  bool holds(std::string_view relation, std::string_view value, const Words& registers) const {
    return condition(relation, value).holds(registers.data());
  }
  bool happens(std::string_view relation, std::string_view value, const Words& before,
               const Words& now) const {
    return condition(relation, value).happens(before.data(), now.data());
  }

  MapPtr owned = MapBuilder().input("x", 0).build();
};

Words real(float value) {
  std::uint32_t raw = 0;
  std::memcpy(&raw, &value, sizeof raw);
  return {static_cast<std::uint16_t>(raw >> 16), static_cast<std::uint16_t>(raw)};
}

TEST_F(ConditionTest, A_number_is_compared_as_a_number_of_its_type) {
  make(Type::INT);
  EXPECT_TRUE(holds("<", "1", {0xFFFF}));  // -1
  EXPECT_FALSE(holds(">=", "0", {0xFFFF}));
  EXPECT_TRUE(holds("<=", "-1", {0xFFFF}));
  EXPECT_TRUE(holds("==", "0xA", {10}));
  EXPECT_TRUE(holds("!=", "10", {11}));
  EXPECT_TRUE(holds(">", "10", {11}));
  EXPECT_FALSE(holds(">", "10", {10}));
}

TEST_F(ConditionTest, Large_integers_are_compared_without_rounding) {
  make(Type::ULINT);
  EXPECT_FALSE(holds("==", "18446744073709551615", {0xFFFE, 0xFFFF, 0xFFFF, 0xFFFF}));
  EXPECT_TRUE(holds("<", "18446744073709551615", {0xFFFE, 0xFFFF, 0xFFFF, 0xFFFF}));
}

TEST_F(ConditionTest, A_scaled_number_equals_the_value_that_is_published) {
  make(Type::INT, [](Point& p) { p.scale.gain = 0.1; });
  EXPECT_TRUE(holds("==", "21.7", {217}));  // 217 x 0.1 is 21.700000000000003
  EXPECT_FALSE(holds(">", "21.7", {217}));
  EXPECT_TRUE(holds(">=", "21.7", {217}));
  EXPECT_TRUE(holds(">", "21.75", {218}));
  EXPECT_FALSE(holds(">", "21.75", {217}));
}

TEST_F(ConditionTest, An_exponent_of_the_device_scales_what_is_compared) {
  owned = MapBuilder()
              .add(Table::holding_registers, "power", 0, Type::INT,
                   [](Point& p) { p.scale.exponent_of = "exponent"; })
              .holding("exponent", 1, Type::INT)
              .build();
  EXPECT_TRUE(holds("==", "21.5", {215, 0xFFFF}));  // 215 x 10^-1
  EXPECT_FALSE(holds(">", "21.5", {215, 0xFFFF}));
  EXPECT_TRUE(holds(">", "21.5", {215, 0}));
}

TEST_F(ConditionTest, A_float_equals_the_text_that_it_is_shown_as) {
  make(Type::REAL);
  EXPECT_TRUE(holds("==", "21.7", real(21.7F)));
  EXPECT_TRUE(holds("==", "0", real(-0.0F)));
}

TEST_F(ConditionTest, What_is_no_number_satisfies_only_not_equal) {
  make(Type::REAL);
  const Words nan = real(std::numeric_limits<float>::quiet_NaN());
  for (const char* relation : {"==", "<", "<=", ">", ">="})
    EXPECT_FALSE(holds(relation, "1", nan)) << relation;
  EXPECT_TRUE(holds("!=", "1", nan));
}

TEST_F(ConditionTest, A_number_that_comes_after_none_has_not_risen) {
  make(Type::REAL);
  EXPECT_FALSE(happens("rises", "1", real(std::numeric_limits<float>::quiet_NaN()), real(2)));
}

TEST_F(ConditionTest, A_scaled_float_equals_the_value_that_is_published) {
  make(Type::REAL, [](Point& p) { p.scale.gain = 0.1; });
  EXPECT_TRUE(holds("==", "21.7", real(217)));
  EXPECT_FALSE(holds("==", "21.7", real(217.001F)));
}

TEST_F(ConditionTest, A_bit_is_on_or_off_rises_and_falls) {
  EXPECT_TRUE(holds("==", "true", {1}));
  EXPECT_TRUE(holds("!=", "on", {0}));
  EXPECT_TRUE(happens("rises", "", {0}, {1}));
  EXPECT_FALSE(happens("rises", "", {1}, {0}));
  EXPECT_TRUE(happens("falls", "", {1}, {0}));
  EXPECT_TRUE(happens("changes", "", {1}, {0}));
  EXPECT_TRUE(condition("falls").holds(Words{0}.data()));
}

TEST_F(ConditionTest, A_number_rises_when_it_reaches_the_value_from_below) {
  make(Type::INT);
  EXPECT_TRUE(happens("rises", "10", {9}, {10}));
  EXPECT_TRUE(happens("rises", "10", {9}, {500}));
  EXPECT_FALSE(happens("rises", "10", {10}, {11}));
  EXPECT_TRUE(happens("falls", "10", {11}, {10}));
  EXPECT_FALSE(happens("falls", "10", {10}, {9}));
  EXPECT_TRUE(condition("rises", "10").holds(Words{10}.data()));
}

TEST_F(ConditionTest, A_text_and_an_array_are_equal_or_not) {
  make(Type::STRING, [](Point& p) { p.format.length = 4; });
  EXPECT_TRUE(holds("==", "ab", {0x6162, 0}) || holds("==", "ab", {0x6261, 0}));
  EXPECT_TRUE(holds("!=", "ab", {0, 0}));
  EXPECT_TRUE(holds("==", "", {0, 0}));
  EXPECT_THAT(error("<", "ab"),
              testing::HasSubstr("'<' does not go with x, which is a text; send ==, != or changes"));
  make(Type::INT, [](Point& p) { p.count = 2; });
  EXPECT_TRUE(holds("==", "[1, 2]", {1, 2}));
  EXPECT_FALSE(holds("==", "[1, 2]", {1, 3}));
  EXPECT_NE(error("rises", "[1, 2]"), "");
}

TEST_F(ConditionTest, A_name_stands_for_its_value) {
  static constexpr NamedValue names[] = {{0, "idle"}, {2, "running"}};
  make(Type::UINT, [](Point& p) { p.values = names; });
  EXPECT_TRUE(holds("==", "running", {2}));
  EXPECT_TRUE(holds(">=", "running", {3}));
  EXPECT_THAT(error("==", "runing"), testing::HasSubstr("send idle (0) or running (2)"));
}

TEST_F(ConditionTest, What_cannot_be_asked_is_refused_with_what_can_be) {
  EXPECT_EQ(error("=", "1"), "'=' is no condition; send ==, !=, rises, falls or changes");
  EXPECT_EQ(error("", "1"), "the goal has no condition; send ==, !=, rises, falls or changes");
  EXPECT_EQ(error("<", "1"), "'<' does not go with x, which is a bit; send ==, !=, rises, falls or changes");
  EXPECT_EQ(error("==", ""), "'==' of x needs a value to compare with; send one");
  EXPECT_EQ(error("rises", "1"), "'rises' of x takes no value, but '1' was sent; leave it out, or send '=='");
  EXPECT_THAT(error("==", "7"), testing::HasSubstr("neither true nor false"));
  make(Type::UINT);
  EXPECT_EQ(error("rises"), "'rises' of x needs a value to compare with; send one");
  EXPECT_THAT(error("==", "70000"), testing::HasSubstr("does not fit into UINT"));
}

}  // namespace
}  // namespace coupler::host
