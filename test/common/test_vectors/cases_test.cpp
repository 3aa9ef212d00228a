// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/cases.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace coupler::test_vectors {
namespace {

using codec::Type;
using codec::Value;
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

TEST(Cases, Nothing_is_refused_where_nothing_can_be_written) {
  Point point = holding(Type::UINT);
  point.access = Access::read;
  EXPECT_THAT(cases_of(point).refused, IsEmpty());
}

}  // namespace
}  // namespace coupler::test_vectors
