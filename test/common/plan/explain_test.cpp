// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/explain.hpp"

#include <gtest/gtest.h>

#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using fakes::MapBuilder;

TEST(Explain, Modicon_numbers_count_from_1_behind_the_tables_digit) {
  EXPECT_EQ(modicon(Table::coils, 0), "00001");
  EXPECT_EQ(modicon(Table::discrete_inputs, 16), "10017");
  EXPECT_EQ(modicon(Table::input_registers, 9998), "39999");
  EXPECT_EQ(modicon(hr, 9999), "410000");
  EXPECT_EQ(modicon(hr, 65535), "465536");
}

/// Why the first request of the map ends.
std::string first_end(MapBuilder builder) {
  const auto owned = builder.build();
  return explain_end(make_read_plan(owned->map()).front().spans.front(), owned->map());
}

TEST(Explain, The_end_of_a_request_names_the_next_point_and_the_key) {
  auto builder = MapBuilder().many(hr, 0, 1).many(hr, 20, 1);
  EXPECT_EQ(
      first_end(builder),
      "19 unmapped addresses before holding_registers_20 may not be read (registers_read_continuous: false)");
  builder.head().polling.register_continuous = true;
  EXPECT_EQ(first_end(builder),
            "19 addresses before holding_registers_20, gap 12 (registers_read_separation_gap)");
  builder.head().polling.register_gap = 100;
  builder.head().limits.read_registers = 16;
  EXPECT_EQ(first_end(builder),
            "with holding_registers_20 more than 16 in a request (limits: read_registers)");
  static const TableRange area[] = {{hr, modbus::Range::of(5, 1)}};
  builder.head().unreadable = area;
  EXPECT_EQ(first_end(builder), "unreadable addresses lie before holding_registers_20");
}

TEST(Explain, Bits_have_keys_of_their_own) {
  EXPECT_EQ(first_end(MapBuilder().many(Table::coils, 0, 1).many(Table::coils, 2, 1)),
            "1 unmapped address before coils_2 may not be read (discrete_read_continuous: false)");
}

TEST(Explain, What_is_read_at_another_rate_is_named_with_it) {
  const auto fast = [](Point& point) { point.host.rate = 2.5; };
  EXPECT_EQ(first_end(MapBuilder().many(hr, 0, 1).add(hr, "slow", 1, codec::Type::UINT, fast)),
            "slow is read at 2.5 Hz");
}

TEST(Explain, A_point_that_can_only_be_written_is_a_reason) {
  const auto written = [](Point& point) { point.access = Access::write; };
  EXPECT_EQ(
      first_end(MapBuilder().many(hr, 0, 1).add(hr, "command", 1, codec::Type::UINT, written).many(hr, 2, 1)),
      "a point that can only be written lies before holding_registers_2");
}

TEST(Explain, The_last_request_of_a_table_ends_with_it) {
  EXPECT_EQ(first_end(MapBuilder().many(hr, 0, 1)), "nothing more to read");
}

}  // namespace
}  // namespace coupler::plan
