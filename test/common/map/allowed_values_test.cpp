// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/allowed_values.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "coupler/codec/value.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler {
namespace {

using codec::Type;
using codec::Value;
using testing::Optional;

constexpr double infinity = std::numeric_limits<double>::infinity();

Point point_of(Type type, Bounds bounds = {}, codec::Scale scale = {}) {
  Point point;
  point.table = Table::holding_registers;
  point.format.type = type;
  point.bounds = bounds;
  point.scale = scale;
  return point;
}

std::vector<std::uint16_t> held(const Point& point, const Value& value) {
  std::vector<std::uint16_t> registers(codec::registers(point.format));
  EXPECT_TRUE(codec::encode(value, point.format, registers.data()));
  return registers;
}

std::optional<Forbidden> why(const Point& point, const Value& value) {
  return why_forbidden(point, held(point, value).data());
}

std::string text(const Point& point, const Value& value) {
  const auto registers = held(point, value);
  const auto found = find_forbidden(point, registers.data());
  return found ? forbidden_text(point, *found) + "; send " + allowed_text(point) : "";
}

TEST(AllowedValues, The_bounds_themselves_are_allowed_and_what_is_beyond_is_not) {
  const Point point = point_of(Type::INT, {-5, 10});
  for (const int good : {-5, 0, 10}) EXPECT_EQ(why(point, std::int64_t{good}), std::nullopt) << good;
  EXPECT_THAT(why(point, std::int64_t{-6}), Optional(Forbidden::below_min));
  EXPECT_THAT(why(point, std::int64_t{11}), Optional(Forbidden::above_max));
}

TEST(AllowedValues, A_bound_that_binary_numbers_do_not_have_is_allowed_all_the_same) {
  EXPECT_EQ(why(point_of(Type::REAL, {0, 21.7}), 21.7F), std::nullopt);  // as float 21.700000763
  EXPECT_THAT(why(point_of(Type::REAL, {0, 21.7}), 21.71F), Optional(Forbidden::above_max));
  const Point tenths = point_of(Type::INT, {-0.3, 21.7}, {0.1});  // 217 * 0.1 is 21.700000000000003
  EXPECT_EQ(why(tenths, std::int64_t{217}), std::nullopt);
  EXPECT_EQ(why(tenths, std::int64_t{-3}), std::nullopt);
  EXPECT_THAT(why(tenths, std::int64_t{218}), Optional(Forbidden::above_max));
}

TEST(AllowedValues, A_negative_gain_turns_no_bounds_round) {
  const Point point = point_of(Type::INT, {-10, 0}, {-1});
  EXPECT_EQ(why(point, std::int64_t{10}), std::nullopt);
  EXPECT_THAT(why(point, std::int64_t{11}), Optional(Forbidden::below_min));
  EXPECT_THAT(why(point, std::int64_t{-1}), Optional(Forbidden::above_max));
}

TEST(AllowedValues, Numbers_that_are_not_finite_are_allowed_only_if_the_map_says_so) {
  for (const double odd : {std::nan(""), infinity, -infinity}) {
    EXPECT_THAT(why(point_of(Type::LREAL), odd), Optional(Forbidden::nonfinite));
    EXPECT_THAT(why(point_of(Type::REAL), static_cast<float>(odd)), Optional(Forbidden::nonfinite));
    EXPECT_EQ(why(point_of(Type::LREAL, {0, 1, true}), odd), std::nullopt);
  }
}

TEST(AllowedValues, With_names_only_named_values_are_allowed) {
  constexpr NamedValue names[] = {{-2, "fault"}, {0, "off"}, {7, "on"}};
  Point point = point_of(Type::SINT);
  point.values = names;
  for (const int good : {-2, 0, 7}) EXPECT_EQ(why(point, std::int64_t{good}), std::nullopt) << good;
  EXPECT_THAT(why(point, std::int64_t{1}), Optional(Forbidden::unnamed));
  EXPECT_EQ(name_of_value(point, held(point, std::int64_t{-2}).data()), "fault");
  EXPECT_EQ(name_of_value(point, held(point, std::int64_t{2}).data()), "");
}

TEST(AllowedValues, A_name_is_not_taken_for_another_number_of_the_same_bits) {
  constexpr NamedValue names[] = {{-1, "fault"}};
  Point point = point_of(Type::ULINT);
  point.values = names;
  EXPECT_EQ(name_of_value(point, held(point, std::numeric_limits<std::uint64_t>::max()).data()), "");
}

TEST(AllowedValues, Each_value_of_an_array_is_looked_at) {
  Point point = point_of(Type::INT, {0, 10});
  point.count = 3;
  const std::uint16_t good[] = {0, 5, 10};
  const std::uint16_t bad[] = {0, 5, 11};
  EXPECT_FALSE(find_forbidden(point, good));
  const auto found = find_forbidden(point, bad);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->registers, bad + 2);
}

TEST(AllowedValues, The_text_says_what_may_be_written) {
  Point point = point_of(Type::INT, {0, 10});
  point.units = "bar";
  EXPECT_EQ(text(point, std::int64_t{12}), "12 bar is above the maximum; send 0 to 10 bar");
  point.bounds = {-5, Bounds::no_max};
  EXPECT_EQ(text(point, std::int64_t{-6}), "-6 bar is below the minimum; send at least -5 bar");
  point.bounds = {Bounds::no_min, 3};
  EXPECT_EQ(text(point, std::int64_t{4}), "4 bar is above the maximum; send at most 3 bar");
  constexpr NamedValue names[] = {{0, "off"}, {1, "idle"}, {2, "auto"}};
  point.bounds = {};
  point.values = names;
  EXPECT_EQ(text(point, std::int64_t{3}), "3 is not one of its values; send off (0), idle (1) or auto (2)");
}

}  // namespace
}  // namespace coupler
