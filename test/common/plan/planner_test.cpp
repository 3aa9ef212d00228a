// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "coupler/plan/planner.hpp"
#include "coupler/plan/split_span.hpp"
#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Range;
using testing::ElementsAre;
using testing::IsEmpty;
using Spans = std::vector<std::string>;

std::string_view text(Cut::Reason reason) {
  switch (reason) {
    case Cut::Reason::end_of_table: return "end";
    case Cut::Reason::other_rate: return "other rate";
    case Cut::Reason::unreadable: return "unreadable";
    case Cut::Reason::write_only: return "write-only";
    case Cut::Reason::unmapped: return "unmapped";
    case Cut::Reason::gap: return "gap";
    case Cut::Reason::limit: return "limit";
  }
  return "?";
}

/// "start+count" of each request, the fastest rate first.
Spans plan(MapBuilder builder) {
  Spans result;
  const auto owned = builder.build();
  for (const GroupPlan& group : make_read_plan(owned->map()))
    for (const ReadSpan& span : group.spans)
      result.push_back(fmt::format("{}+{}", span.range.start(), span.range.count()));
  return result;
}

/// Why each request ends, how many addresses before the next point.
Spans cuts(MapBuilder builder) {
  Spans result;
  const auto owned = builder.build();
  for (const GroupPlan& group : make_read_plan(owned->map()))
    for (const ReadSpan& span : group.spans) {
      auto cut = fmt::format("{}", text(span.end.reason));
      if (span.end.next)
        cut += fmt::format(", {} to {}", span.end.between, owned->map().points[*span.end.next].name);
      result.push_back(cut);
    }
  return result;
}

MapBuilder registers(std::initializer_list<std::uint16_t> addresses, bool continuous = false) {
  MapBuilder builder;
  for (const std::uint16_t address : addresses) builder.many(hr, address, 1);
  builder.head().polling.register_continuous = continuous;
  return builder;
}

auto at_rate(double rate) {
  return [rate](Point& point) { point.host.rate = rate; };
}
void written_only(Point& point) { point.access = Access::write; }

TEST(Planner, A_map_without_points_needs_no_request) { EXPECT_THAT(plan(MapBuilder()), IsEmpty()); }

TEST(Planner, Adjacent_points_are_read_together) {
  EXPECT_THAT(plan(registers({10, 15}).add(hr, "wide", 11, Type::LREAL)), ElementsAre("10+6"));
}

TEST(Planner, Points_that_are_apart_are_read_apart_unless_the_map_allows_unmapped_addresses) {
  EXPECT_THAT(plan(registers({10, 12})), ElementsAre("10+1", "12+1"));
  EXPECT_THAT(cuts(registers({10, 12})), ElementsAre("unmapped, 1 to holding_registers_12", "end"));
  EXPECT_THAT(plan(registers({10, 12}, true)), ElementsAre("10+3"));
}

TEST(Planner, Points_are_joined_only_when_the_distance_is_strictly_below_the_gap) {
  EXPECT_THAT(plan(registers({0, 12, 25}, true)), ElementsAre("0+13", "25+1"))
      << "11 between, then 12; the gap is 12";
  EXPECT_THAT(cuts(registers({0, 12, 25}, true)), ElementsAre("gap, 12 to holding_registers_25", "end"));
}

TEST(Planner, A_gap_of_0_still_joins_what_touches) {
  auto builder = registers({0, 1, 3}, true);
  builder.head().polling.register_gap = 0;
  EXPECT_THAT(plan(builder), ElementsAre("0+2", "3+1"));
}

TEST(Planner, Bits_have_their_own_gap) {
  auto builder = MapBuilder().many(co, 0, 1).many(co, 64, 1).many(co, 129, 1);
  builder.head().polling.discrete_continuous = true;
  EXPECT_THAT(plan(builder), ElementsAre("0+65", "129+1")) << "63 unmapped bits, then 64; the gap is 64";
}

TEST(Planner, Tables_are_never_joined) {
  EXPECT_THAT(
      plan(MapBuilder().many(co, 0, 1).many(Table::discrete_inputs, 1, 1).many(ir, 2, 1).many(hr, 3, 1)),
      ElementsAre("0+1", "1+1", "2+1", "3+1"));
}

TEST(Planner, A_request_has_at_most_125_registers) {
  EXPECT_THAT(plan(MapBuilder().many(hr, 0, 126)), ElementsAre("0+125", "125+1"));
  EXPECT_THAT(cuts(MapBuilder().many(hr, 0, 126)), ElementsAre("limit, 0 to holding_registers_125", "end"));
}

TEST(Planner, A_request_has_at_most_2000_bits) {
  auto builder = MapBuilder().many(co, 0, 1).many(co, 1999, 2);
  builder.head().polling.discrete_continuous = true;
  builder.head().polling.discrete_gap = 5000;
  EXPECT_THAT(plan(builder), ElementsAre("0+2000", "2000+1"));
}

TEST(Planner, A_device_that_takes_fewer_is_asked_for_fewer) {
  auto builder = registers({0, 1, 2});
  builder.head().limits.read_registers = 2;
  EXPECT_THAT(plan(builder), ElementsAre("0+2", "2+1"));
}

TEST(Planner, A_point_is_never_split) {
  auto builder = registers({0}).add(hr, "wide", 1, Type::LREAL);
  builder.head().limits.read_registers = 4;
  EXPECT_THAT(plan(builder), ElementsAre("0+1", "1+4"));
}

TEST(Planner, An_array_is_read_whole) {
  auto builder = registers({0}).add(hr, "array", 1, Type::REAL, [](Point& point) { point.count = 60; });
  EXPECT_THAT(plan(builder), ElementsAre("0+121"));
  builder.head().limits.read_registers = 120;
  EXPECT_THAT(plan(builder), ElementsAre("0+1", "1+120"));
}

TEST(Planner, Overlapping_points_are_read_once) {
  EXPECT_THAT(plan(registers({1, 5}).add(hr, "wide", 0, Type::LREAL)), ElementsAre("0+4", "5+1"));
}

TEST(Planner, A_point_is_read_where_it_reads_back) {
  const auto reads_back_at = [](std::uint16_t address) {
    return [=](Point& p) { p.read_address = address; };
  };
  EXPECT_THAT(plan(MapBuilder()
                       .add(co, "a", 0, Type::BOOL, reads_back_at(513))
                       .add(co, "b", 1, Type::BOOL, reads_back_at(512))),
              ElementsAre("512+2"));
}

TEST(Planner, A_point_that_can_only_be_written_is_not_read) {
  const auto owned = MapBuilder().add(hr, "command", 1, Type::UINT, written_only).build();
  EXPECT_THAT(make_read_plan(owned->map()), IsEmpty());
  EXPECT_EQ(why_not_read(owned->map(), owned->map().points[0]), NotRead::write_only);
}

TEST(Planner, A_point_that_can_only_be_written_is_not_read_across_either) {
  const auto builder = registers({0, 2}, true).add(hr, "command", 1, Type::UINT, written_only);
  EXPECT_THAT(plan(builder), ElementsAre("0+1", "2+1"));
  EXPECT_THAT(cuts(builder), ElementsAre("write-only, 1 to holding_registers_2", "end"));
}

TEST(Planner, A_register_of_which_one_bit_can_only_be_written_is_read_for_the_others) {
  const auto builder = registers({0, 2}, true)
                           .add(hr, "reset", 1, Type::BOOL, written_only)
                           .add(hr, "state", 1, Type::BOOL, [](Point& point) { point.format.bit = 1; });
  EXPECT_THAT(plan(builder), ElementsAre("0+3"));
}

TEST(Planner, What_the_map_calls_unreadable_is_never_read_across) {
  static const TableRange area[] = {{hr, modbus::Range::of(2, 2)}};
  auto builder = registers({0, 1, 5, 6}, true);
  EXPECT_THAT(plan(builder), ElementsAre("0+7"));
  builder.head().unreadable = area;
  EXPECT_THAT(plan(builder), ElementsAre("0+2", "5+2"));
  EXPECT_THAT(cuts(builder), ElementsAre("unreadable, 3 to holding_registers_5", "end"));
}

TEST(Planner, A_point_that_the_map_calls_unreadable_is_not_read) {
  static const TableRange area[] = {{hr, modbus::Range::of(1, 1)}};
  auto builder = registers({0, 1, 2}, true);
  builder.head().unreadable = area;
  EXPECT_THAT(plan(builder), ElementsAre("0+1", "2+1"));
  const auto owned = builder.build();
  EXPECT_EQ(why_not_read(owned->map(), owned->map().points[1]), NotRead::unreadable);
  EXPECT_EQ(why_not_read(owned->map(), owned->map().points[2]), std::nullopt);
}

TEST(Planner, An_area_that_the_device_gives_whole_is_read_whole_for_any_of_its_points) {
  static const TableRange areas[] = {{hr, Range::of(2, 6)}, {hr, Range::of(20, 10)}};
  auto builder = registers({0, 4, 5, 12, 25});
  builder.head().read_whole = areas;
  EXPECT_THAT(plan(builder), ElementsAre("0+1", "2+6", "12+1", "20+10"));
  const auto owned = builder.build();
  const Planner planner(owned->map());
  const std::uint32_t only[] = {2};  // as with --points
  const auto spans = planner.plan(only);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].range, Range::of(2, 6));
  EXPECT_THAT(holes(spans[0], owned->map()), IsEmpty());
}

TEST(Planner, A_point_that_reaches_into_two_such_areas_asks_for_both) {
  static const TableRange areas[] = {{hr, Range::of(0, 4)}, {hr, Range::of(5, 4)}, {ir, Range::of(0, 9)}};
  auto builder = MapBuilder().add(hr, "wide", 3, Type::LREAL);
  builder.head().read_whole = areas;
  EXPECT_THAT(plan(builder), ElementsAre("0+9"));
}

TEST(Planner, A_request_that_is_rejected_is_not_parted_inside_such_an_area) {
  static const TableRange areas[] = {{hr, Range::of(2, 6)}};
  auto builder = registers({1, 2, 7, 8, 9}, true);
  builder.head().read_whole = areas;
  const auto owned = builder.build();
  const auto group = make_read_plan(owned->map());
  ASSERT_EQ(group.front().spans.size(), 1U);
  const Split parts = split(group.front().spans.front(), owned->map());
  ASSERT_EQ(parts.pieces.size(), 2U);
  EXPECT_EQ(parts.pieces[0].range, Range::of(1, 1));
  EXPECT_EQ(parts.pieces[1].range, Range::of(2, 8));
}

TEST(Planner, A_point_that_fits_into_no_reply_is_not_read) {
  const auto owned =
      MapBuilder().add(hr, "a", 0, Type::UINT, [](Point& point) { point.count = 126; }).build();
  EXPECT_EQ(why_not_read(owned->map(), owned->map().points[0]), NotRead::too_long);
  EXPECT_THAT(make_read_plan(owned->map()), IsEmpty());
}

TEST(Planner, The_last_address_of_a_table_can_be_read) {
  EXPECT_THAT(plan(registers({65534, 65535})), ElementsAre("65534+2"));
}

TEST(Planner, Points_of_different_rates_are_read_apart_the_fastest_first) {
  auto builder = MapBuilder()
                     .add(hr, "slow", 0, Type::UINT, at_rate(1))
                     .add(hr, "the_maps", 1, Type::UINT)
                     .add(hr, "fast", 2, Type::UINT, at_rate(100));
  EXPECT_THAT(plan(builder), ElementsAre("2+1", "1+1", "0+1"));
  EXPECT_THAT(cuts(builder), ElementsAre("end", "other rate, 0 to fast", "other rate, 0 to the_maps"));
}

TEST(Planner, Addresses_that_are_read_at_another_rate_are_no_unmapped_ones) {
  auto builder = registers({0, 2}).add(hr, "slow", 1, Type::UINT, at_rate(1));
  EXPECT_THAT(plan(builder), ElementsAre("0+3", "1+1"));
  builder.head().polling.register_gap = 1;
  EXPECT_THAT(cuts(builder),
              ElementsAre("gap, 1 to holding_registers_2", "end", "other rate, 0 to holding_registers_2"));
}

TEST(Planner, A_subset_of_the_points_is_planned_by_itself) {
  const auto owned = MapBuilder().many(hr, 0, 125).many(hr, 200, 1).build();
  const Planner planner(owned->map());
  const auto spans = planner.plan(std::vector<std::uint32_t>{3, 5, 125});
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].range, modbus::Range::of(3, 3))
      << "between lies a point that is not wanted: it can be read";
  EXPECT_EQ(spans[1].range, modbus::Range::of(200, 1));
}

TEST(Planner, A_request_that_contains_a_refused_range_is_not_made) {
  const auto owned = registers({0, 1, 2, 3}).build();
  const Planner planner(owned->map());
  const std::vector<TableRange> refused{{hr, modbus::Range::of(1, 2)}, {ir, modbus::Range::of(2, 1)}};
  const auto spans = planner.plan(planner.groups().front().points, refused);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].range, modbus::Range::of(0, 2));
  EXPECT_EQ(spans[1].range, modbus::Range::of(2, 2));
}

TEST(Planner, A_refused_range_keeps_points_apart_but_leaves_none_out) {
  const auto owned = registers({0, 1, 2}).build();
  const Planner planner(owned->map());
  const std::vector<TableRange> refused{{hr, modbus::Range::of(1, 1)}};
  const auto spans = planner.plan(planner.groups().front().points, refused);
  ASSERT_EQ(spans.size(), 3U);
  EXPECT_EQ(spans[1].range, modbus::Range::of(1, 1));
}

}  // namespace

namespace {

using modbus::Range;

const Intervals set({Range::of(10, 5), Range::of(15, 5), Range::of(12, 1), Range::of(30, 1)});

TEST(Intervals, What_touches_or_overlaps_is_one) { EXPECT_TRUE(set.covers(Range::of(10, 10))); }

TEST(Intervals, A_range_is_covered_only_as_a_whole) {
  EXPECT_FALSE(set.covers(Range::of(9, 2)));
  EXPECT_FALSE(set.covers(Range::of(19, 2)));
  EXPECT_FALSE(set.covers(Range::of(18, 13)));
  EXPECT_TRUE(set.covers(Range::of(30, 1)));
}

TEST(Intervals, One_common_address_is_an_overlap) {
  EXPECT_TRUE(set.overlaps(Range::of(0, 11)));
  EXPECT_TRUE(set.overlaps(Range::of(19, 5)));
  EXPECT_FALSE(set.overlaps(Range::of(20, 10)));
  EXPECT_FALSE(set.overlaps(Range::of(31, 100)));
}

TEST(Intervals, The_empty_set_has_nothing) {
  EXPECT_FALSE(Intervals().covers(Range::of(0, 1)));
  EXPECT_FALSE(Intervals().overlaps(Range::of(0, 65536)));
}

}  // namespace
}  // namespace coupler::plan
