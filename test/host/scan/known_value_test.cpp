// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/known_value.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/host/scan/draft.hpp"

namespace coupler::scan {
namespace {

using codec::Order;
using codec::Type;
using modbus::Range;

constexpr Order orders[] = {Order::ABCD, Order::CDAB, Order::BADC, Order::DCBA};

KnownValue known(std::string_view text) { return parse_known_value(text).value(); }

/// Registers 0 … 99 that hold noise, and a value.
template <class T>
std::vector<TableFindings> registers_with(T value, Order order, std::uint32_t address) {
  std::vector<std::uint16_t> words(100);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = static_cast<std::uint16_t>(40503 * i + 7);
  codec::encode(value, order, &words[address]);
  std::vector<TableFindings> tables;
  tables.emplace_back(Table::holding_registers, Range::of(0, 100));
  tables.back().add_values(Range::of(0, 100), words.data());
  return tables;
}

TEST(KnownValue, It_is_as_exact_as_it_is_written) {
  EXPECT_DOUBLE_EQ(known("230.4").tolerance, 0.05);
  EXPECT_DOUBLE_EQ(known("230").tolerance, 0.5);
  EXPECT_DOUBLE_EQ(known("12e3").tolerance, 500);
  EXPECT_DOUBLE_EQ(known("1.50e-1").tolerance, 0.0005);
}

TEST(KnownValue, A_tolerance_and_a_name_may_be_given) {
  const KnownValue voltage = known("voltage=230.4±2");
  EXPECT_EQ(voltage.name, "voltage");
  EXPECT_DOUBLE_EQ(voltage.value, 230.4);
  EXPECT_DOUBLE_EQ(voltage.tolerance, 2);
  EXPECT_DOUBLE_EQ(known("-5+-0.1").value, -5);
}

TEST(KnownValue, What_cannot_be_searched_for_is_refused) {
  for (const auto* text : {"", "x", "0", "0.0", "1±2", "3±", "3±-1", "1 2=3", "status=4", "=4", "nan"})
    EXPECT_FALSE(parse_known_value(text)) << text;
}

TEST(Candidates, A_real_is_found_in_each_order) {
  for (const Order order : orders) {
    const auto found = find_candidates(known("230.4"), registers_with(230.4F, order, 41));
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].type, Type::REAL);
    EXPECT_EQ(found[0].order, order);
    EXPECT_EQ(found[0].range, Range::of(41, 2));
  }
}

TEST(Candidates, A_long_real_is_found_in_each_order) {
  for (const Order order : orders) {
    const auto found = find_candidates(known("-1.2345"), registers_with(-1.2345, order, 3));
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].type, Type::LREAL);
    EXPECT_EQ(found[0].order, order);
  }
}

TEST(Candidates, Wide_integers_are_found_in_each_order) {
  for (const Order order : orders) {
    const auto positive = find_candidates(known("305419896"), registers_with(305419896U, order, 10));
    ASSERT_FALSE(positive.empty());
    EXPECT_EQ(point_text(positive[0], true),
              fmt::format("{{address: 10, type: UDINT, order: {}}}", to_string(order, false)));
    const auto negative = find_candidates(known("-70000"), registers_with(-70000, order, 10));
    ASSERT_FALSE(negative.empty());
    EXPECT_EQ(negative[0].type, Type::DINT);
    EXPECT_EQ(negative[0].order, order);
  }
}

TEST(Candidates, Tenths_and_hundredths_are_found) {
  const auto tenths = find_candidates(known("230.4"), registers_with(std::uint16_t{2304}, Order::ABCD, 5));
  ASSERT_FALSE(tenths.empty());
  EXPECT_EQ(point_text(tenths[0], true), "{address: 5, type: UINT, order: AB, scale: 0.1}");
  const auto hundredths =
      find_candidates(known("-50.02"), registers_with(std::int16_t{-5002}, Order::BADC, 5));
  ASSERT_FALSE(hundredths.empty());
  EXPECT_EQ(point_text(hundredths[0], true), "{address: 5, type: INT, order: BA, scale: 0.01}");
}

TEST(Candidates, The_least_likely_coincidence_comes_first) {
  auto tables = registers_with(230.4F, Order::CDAB, 20);
  const std::uint16_t by_chance = 23040;
  tables[0].add_values(Range::of(0, 1), &by_chance);
  const auto found = find_candidates(known("230.4"), tables);
  ASSERT_GE(found.size(), 2U);
  EXPECT_EQ(found[0].type, Type::REAL);
  EXPECT_THAT(found, testing::Contains(testing::Field(&Candidate::range, Range::of(0, 1))));
}

TEST(Candidates, Nothing_is_found_across_a_hole_or_a_seam) {
  auto tables = registers_with(230.4F, Order::ABCD, 41);
  tables[0].add_seam(42);
  EXPECT_THAT(find_candidates(known("230.4±0.0001"), tables), testing::IsEmpty());
}

TEST(Candidates, The_order_of_the_device_is_the_one_that_all_values_know) {
  const auto real = find_candidates(known("230.4"), registers_with(230.4F, Order::DCBA, 0));
  const auto count = find_candidates(known("70001"), registers_with(70001U, Order::DCBA, 8));
  EXPECT_EQ(common_order({Match{{}, real}, Match{{}, count}}), Order::DCBA);
  const auto other = find_candidates(known("70001"), registers_with(70001U, Order::ABCD, 8));
  EXPECT_EQ(common_order({Match{{}, real}, Match{{}, other}}), std::nullopt);
}

TEST(Candidates, One_register_does_not_tell_the_order_of_words) {
  const auto word = find_candidates(known("513"), registers_with(std::uint16_t{513}, Order::ABCD, 0));
  EXPECT_EQ(common_order({Match{{}, word}}), std::nullopt);
}

}  // namespace
}  // namespace coupler::scan
