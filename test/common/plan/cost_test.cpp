// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/plan/cost.hpp"
#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

ReadSpan span(Table table, std::uint32_t count) { return {table, modbus::Range::of(0, count), {0}}; }

TEST(Cost, The_bytes_are_those_of_the_two_adus) {
  // MAP 6.1 and 6.3, TCP 3.1: 12 bytes ask, 7 + 2 + values answer.
  EXPECT_EQ(cost_of(span(Table::holding_registers, 10), {}).bytes, 12U + 29U);
  EXPECT_EQ(cost_of(span(Table::coils, 9), {}).bytes, 12U + 11U);
}

TEST(Cost, Bits_and_registers_are_counted_apart) {
  const Cost registers = cost_of(span(Table::input_registers, 10), {});
  EXPECT_EQ(registers.registers, 10U);
  EXPECT_EQ(registers.bits, 0U);
  EXPECT_EQ(cost_of(span(Table::discrete_inputs, 10), {}).bits, 10U);
}

TEST(Cost, A_request_takes_the_round_trip_the_pause_and_the_time_of_its_values) {
  const NetworkTiming timing{milliseconds(2), milliseconds(3)};
  EXPECT_EQ(cost_of(span(Table::holding_registers, 100), timing).time, milliseconds(5) + nanoseconds(16000));
}

TEST(Cost, On_a_serial_line_the_characters_take_their_time) {
  fakes::MapBuilder builder;
  builder.head().connection.serial = {"/dev/ttyUSB0", 9600, Serial::Parity::none, 1, false};
  const NetworkTiming timing = timing_of(builder.build()->map(), milliseconds(5));
  // MSL 2.5.1: 8 characters ask, 5 + 20 answer, 10 bits each, and 3.5 of silence.
  const double characters = 8 + 25 + 3.5;
  EXPECT_NEAR(static_cast<double>(cost_of(span(Table::holding_registers, 10), timing).time.count()) / 1e6,
              5 + characters * 10 / 9.6, 0.001);
  EXPECT_EQ(cost_of(span(Table::holding_registers, 10), timing).bytes, 8U + 25U);
}

TEST(Cost, A_pause_that_the_device_needs_is_as_long_as_the_silence_at_least) {
  fakes::MapBuilder builder;
  builder.head().connection.serial.device = "/dev/ttyUSB0";
  builder.head().limits.request_gap = milliseconds(20);
  EXPECT_EQ(timing_of(builder.build()->map(), milliseconds(1)).pause, milliseconds(20));
}

TEST(Cost, Requests_of_a_cycle_follow_one_another) {
  const GroupPlan group{10, {span(Table::coils, 8), span(Table::coils, 16)}};
  const Cost cost = cost_of(group, {});
  EXPECT_EQ(cost.requests, 2U);
  EXPECT_EQ(cost.bits, 24U);
  EXPECT_EQ(cost.time, milliseconds(2) + nanoseconds(3 * 80));
}

TEST(Cost, The_load_of_all_rates_adds_up) {
  const NetworkTiming timing{milliseconds(10)};
  const std::vector<GroupPlan> plan{{50, {span(Table::coils, 8)}}, {10, {span(Table::coils, 8)}}};
  EXPECT_NEAR(load(plan, timing), 0.6, 0.001);
}

}  // namespace

namespace {

using fakes::MapBuilder;

TEST(Strategy, Holes_cost_requests_unless_they_are_read) {
  auto builder = MapBuilder().many(hr, 0, 1).many(hr, 3, 1).many(hr, 50, 1);
  builder.head().polling.register_continuous = true;
  const auto [never, map, pays] = compare_strategies(builder.build()->map(), {});
  EXPECT_EQ(never.cost.requests, 3U);
  EXPECT_EQ(map.cost.requests, 2U);
  EXPECT_EQ(pays.cost.requests, 1U);
  EXPECT_GT(never.load, map.load);
  EXPECT_GT(map.load, pays.load);
}

TEST(Strategy, The_proposed_gap_is_the_smallest_that_does_it) {
  const auto owned = MapBuilder().many(hr, 0, 1).many(hr, 3, 1).many(hr, 50, 1).many(hr, 500, 1).build();
  const Strategy pays = compare_strategies(owned->map(), {})[2];
  EXPECT_TRUE(pays.polling.register_continuous);
  EXPECT_EQ(pays.polling.register_gap, 47);
  Map map = owned->map();
  map.polling = pays.polling;
  EXPECT_EQ(make_read_plan(map).front().spans.size(), pays.cost.requests);
  map.polling.register_gap = 46;
  EXPECT_EQ(make_read_plan(map).front().spans.size(), pays.cost.requests + 1);
}

TEST(Strategy, Without_holes_to_read_nothing_is_proposed) {
  const auto owned = MapBuilder().many(hr, 0, 10).many(hr, 500, 1).build();
  const Strategy pays = compare_strategies(owned->map(), {})[2];
  EXPECT_FALSE(pays.polling.register_continuous);
  EXPECT_FALSE(pays.polling.discrete_continuous);
  EXPECT_EQ(pays.polling.register_gap, owned->map().polling.register_gap);
}

TEST(Strategy, A_hole_that_takes_longer_than_a_request_does_not_pay) {
  const auto owned = MapBuilder().many(hr, 0, 1).many(hr, 20, 1).build();
  const NetworkTiming quick{std::chrono::microseconds(1)};  // 6 registers take as long
  EXPECT_EQ(compare_strategies(owned->map(), quick)[2].cost.requests, 2U);
  EXPECT_EQ(compare_strategies(owned->map(), {})[2].cost.requests, 1U);
}

}  // namespace
}  // namespace coupler::plan
