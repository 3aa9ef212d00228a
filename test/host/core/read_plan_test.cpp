// SPDX-License-Identifier: Apache-2.0
#include "host/core/read_plan.hpp"

#include <gtest/gtest.h>

#include "test/host/core/make_map.hpp"

namespace coupler::driver {
namespace {

using codec::Type;
using test::MapBuilder;

/// "start+count" of each span.
std::vector<std::string> text(const std::vector<ReadSpan>& spans) {
  std::vector<std::string> result;
  for (const ReadSpan& span : spans)
    result.push_back(std::to_string(span.range.start()) + "+" + std::to_string(span.range.count()));
  return result;
}
std::vector<std::string> plan(const MapBuilder& builder) {
  return text(make_read_plan(builder.build()->map()));
}

using Spans = std::vector<std::string>;

TEST(ReadPlan, A_map_without_points_needs_no_request) { EXPECT_EQ(plan(MapBuilder()), Spans{}); }

TEST(ReadPlan, Adjacent_points_are_read_together) {
  EXPECT_EQ(plan(MapBuilder().holding("a", 10).holding("b", 11, Type::LREAL).holding("c", 15)),
            Spans{"10+6"});
}

TEST(ReadPlan, Points_that_are_apart_are_read_apart_unless_the_map_allows_unmapped_addresses) {
  auto builder = MapBuilder().holding("a", 10).holding("b", 12);
  EXPECT_EQ(plan(builder), (Spans{"10+1", "12+1"}));
  builder.head().polling.register_continuous = true;
  EXPECT_EQ(plan(builder), Spans{"10+3"});
}

TEST(ReadPlan, Points_are_joined_only_when_the_distance_is_strictly_below_the_gap) {
  auto builder = MapBuilder().input_register("a", 0).input_register("eleven_between", 12);
  builder.head().polling.register_continuous = true;
  builder.head().polling.register_gap = 12;
  EXPECT_EQ(plan(builder), Spans{"0+13"});
  builder.input_register("twelve_between", 25);
  EXPECT_EQ(plan(builder), (Spans{"0+13", "25+1"}));
}

TEST(ReadPlan, A_gap_of_0_still_joins_what_touches) {
  auto builder = MapBuilder().holding("a", 0).holding("b", 1).holding("c", 3);
  builder.head().polling.register_continuous = true;
  builder.head().polling.register_gap = 0;
  EXPECT_EQ(plan(builder), (Spans{"0+2", "3+1"}));
}

TEST(ReadPlan, Bits_have_their_own_gap) {
  auto builder = MapBuilder().input("a", 0).input("b", 64);
  builder.head().polling.discrete_continuous = true;
  EXPECT_EQ(plan(builder), Spans{"0+65"}) << "63 unmapped bits, gap 64";
  builder.input("c", 129);
  EXPECT_EQ(plan(builder), (Spans{"0+65", "129+1"}));
}

TEST(ReadPlan, Tables_are_never_joined) {
  EXPECT_EQ(plan(MapBuilder().coil("a", 0).input("b", 1).input_register("c", 2).holding("d", 3)),
            (Spans{"0+1", "1+1", "2+1", "3+1"}));
}

TEST(ReadPlan, A_request_has_at_most_125_registers) {
  MapBuilder builder;
  std::vector<std::string> names(126);
  for (std::uint16_t i = 0; i < 126; ++i) builder.holding(names[i] = "p" + std::to_string(i), i);
  EXPECT_EQ(plan(builder), (Spans{"0+125", "125+1"}));
}

TEST(ReadPlan, A_request_has_at_most_2000_bits) {
  auto builder = MapBuilder().coil("a", 0).coil("b", 1999).coil("c", 2000);
  builder.head().polling.discrete_continuous = true;
  builder.head().polling.discrete_gap = 5000;
  EXPECT_EQ(plan(builder), (Spans{"0+2000", "2000+1"}));
}

TEST(ReadPlan, A_device_that_takes_fewer_is_asked_for_fewer) {
  auto builder = MapBuilder().holding("a", 0).holding("b", 1).holding("c", 2);
  builder.head().limits.read_registers = 2;
  EXPECT_EQ(plan(builder), (Spans{"0+2", "2+1"}));
}

TEST(ReadPlan, A_point_is_never_split) {
  auto builder = MapBuilder().holding("a", 0).holding("wide", 1, Type::LREAL);
  builder.head().limits.read_registers = 4;
  EXPECT_EQ(plan(builder), (Spans{"0+1", "1+4"}));
}

TEST(ReadPlan, Overlapping_points_are_read_once) {
  const auto owned = MapBuilder().input_register("wide", 0, Type::LREAL).input_register("part", 1).build();
  const auto spans = make_read_plan(owned->map());
  EXPECT_EQ(text(spans), Spans{"0+4"});
  EXPECT_EQ(spans.front().points.size(), 2U);
}

TEST(ReadPlan, A_point_that_can_only_be_written_is_not_read) {
  auto builder = MapBuilder().holding("a", 0);
  builder.point("command", Table::holding_registers, 1, MapBuilder::format(Type::UINT), Access::write);
  EXPECT_EQ(plan(builder), Spans{"0+1"});
}

TEST(ReadPlan, The_last_address_of_a_table_can_be_read) {
  EXPECT_EQ(plan(MapBuilder().holding("a", 65534).holding("b", 65535)), Spans{"65534+2"});
}

TEST(Split, A_rejected_span_is_first_read_without_its_unmapped_addresses) {
  auto builder = MapBuilder().holding("a", 0).holding("b", 1).holding("c", 5);
  builder.head().polling.register_continuous = true;
  const auto owned = builder.build();
  const auto spans = make_read_plan(owned->map());
  ASSERT_EQ(text(spans), Spans{"0+6"});
  EXPECT_EQ(text(split(spans.front(), owned->map())), (Spans{"0+2", "5+1"}));
}

TEST(Split, A_rejected_span_without_unmapped_addresses_is_halved_by_points) {
  const auto owned = MapBuilder().holding("a", 0, Type::LREAL).holding("b", 4).holding("c", 5).build();
  const auto spans = make_read_plan(owned->map());
  EXPECT_EQ(text(split(spans.front(), owned->map())), (Spans{"0+4", "4+2"}));
}

TEST(Split, A_lone_point_is_not_split) {
  const auto owned = MapBuilder().holding("a", 0, Type::LREAL).build();
  EXPECT_TRUE(split(make_read_plan(owned->map()).front(), owned->map()).empty());
}

}  // namespace
}  // namespace coupler::driver
