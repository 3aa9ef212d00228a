// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/cases.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

namespace coupler::test_vectors {
namespace {

using codec::Type;
using codec::Value;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Point holding(Type type) {
  Point point;
  point.table = Table::holding_registers;
  point.format.type = type;
  point.access = Access::read_write;
  return point;
}

TEST(Cases, Bits_are_off_and_on_and_those_of_an_array_also_mixed) {
  Point point;
  EXPECT_EQ(cases_of(point).cases.size(), 2U);
  point.count = 3;
  std::vector<std::vector<std::uint16_t>> seen;
  for (const Case& one : cases_of(point).cases) seen.push_back(one.raw);
  using Raw = std::vector<std::uint16_t>;
  EXPECT_THAT(seen, ElementsAre(Raw{0, 0, 0}, Raw{1, 1, 1}, Raw{0, 1, 0}, Raw{1, 0, 1}));
}

TEST(Cases, No_two_are_alike) {
  Point point = holding(Type::STRING);
  point.format.length = 1;
  const auto cases = cases_of(point).cases;
  for (const Case& one : cases)
    EXPECT_EQ(
        std::count_if(cases.begin(), cases.end(), [&](const Case& other) { return other.raw == one.raw; }),
        1);
}

TEST(Cases, A_scaled_value_that_rounds_is_only_read) {
  Point point = holding(Type::LINT);
  point.scale.gain = 0.001;
  const auto cases = cases_of(point).cases;
  const auto only_read = [](const Case& one) { return one.only_read; };
  EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), only_read));  // 2^63 - 1 has more digits than a double
  EXPECT_FALSE(only_read(cases[0]));
  EXPECT_EQ(std::get<double>(cases[1].values[0]), 0.001);
}

TEST(Cases, Numbers_beyond_an_integer_are_refused) {
  EXPECT_THAT(cases_of(holding(Type::USINT)).refused, ElementsAre(std::int64_t{-1}, std::int64_t{256}));
  EXPECT_THAT(cases_of(holding(Type::LINT)).refused, ElementsAre(std::uint64_t{1} << 63U));
  EXPECT_THAT(cases_of(holding(Type::LREAL)).refused, IsEmpty());
}

TEST(Cases, Numbers_beyond_a_scale_are_refused) {
  Point point = holding(Type::UINT);
  point.scale.gain = 0.5;
  EXPECT_THAT(cases_of(point).refused, Contains(Value(65535.0)));
}

bool has(const std::vector<Case>& cases, const Value& value) {
  return std::any_of(cases.begin(), cases.end(),
                     [&](const Case& one) { return one.values[0] == value && !one.only_read; });
}

TEST(Cases, A_bound_is_written_and_the_next_integer_is_refused) {
  Point point = holding(Type::INT);
  point.bounds.min = -3;
  point.bounds.max = 7;
  const Cases made = cases_of(point);
  EXPECT_TRUE(has(made.cases, std::int64_t{-3}));
  EXPECT_TRUE(has(made.cases, std::int64_t{7}));
  EXPECT_THAT(made.refused, AllOf(Contains(Value(std::int64_t{-4})), Contains(Value(std::int64_t{8}))));
}

TEST(Cases, A_bound_above_63_bits_is_written_and_what_lies_beyond_is_refused) {
  Point point = holding(Type::ULINT);
  point.bounds.min = 9223372036854775808.0;
  point.bounds.max = 10000000000000000000.0;
  const Cases made = cases_of(point);
  EXPECT_TRUE(has(made.cases, std::uint64_t{9223372036854775808U}));
  EXPECT_TRUE(has(made.cases, std::uint64_t{10000000000000000000U}));
  // The doubles next to them.
  EXPECT_THAT(made.refused, ElementsAre(std::int64_t{-1}, std::int64_t{9223372036854774784},
                                        std::uint64_t{10000000000000002048U}));
}

TEST(Cases, A_bound_at_the_end_of_64_bits_has_nothing_beyond) {
  Point point = holding(Type::ULINT);
  point.bounds.max = 18446744073709551616.0;  // as the last ULINT is read from a map
  EXPECT_THAT(cases_of(point).refused, ElementsAre(std::int64_t{-1}));
  EXPECT_TRUE(has(cases_of(point).cases, std::numeric_limits<std::uint64_t>::max()));

  point = holding(Type::LINT);
  point.bounds.min = -9223372036854775808.0;
  point.bounds.max = 9223372036854775808.0;
  const Cases made = cases_of(point);
  EXPECT_TRUE(has(made.cases, std::numeric_limits<std::int64_t>::min()));
  EXPECT_TRUE(has(made.cases, std::numeric_limits<std::int64_t>::max()));
  for (const Value& value : made.refused) EXPECT_TRUE(std::holds_alternative<std::uint64_t>(value));
}

TEST(Cases, The_number_behind_the_last_name_is_refused_also_of_the_greatest_integer) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const NamedValue last[] = {{most - 1, "near"}, {most, "far"}};
  for (const Type type : {Type::LINT, Type::ULINT}) {
    Point point = holding(type);
    point.values = last;
    EXPECT_THAT(cases_of(point).refused, Contains(Value(static_cast<std::uint64_t>(most) + 1)));
  }
  const NamedValue gap[] = {{0, "idle"}, {1, "running"}, {3, "failed"}};
  Point point = holding(Type::INT);
  point.values = gap;
  EXPECT_THAT(cases_of(point).refused, Contains(Value(std::int64_t{2})));
}

TEST(Cases, Nothing_is_refused_where_nothing_can_be_written) {
  Point point = holding(Type::UINT);
  point.access = Access::read;
  EXPECT_THAT(cases_of(point).refused, IsEmpty());
}

}  // namespace
}  // namespace coupler::test_vectors
