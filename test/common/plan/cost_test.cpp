// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/cost.hpp"

#include <gtest/gtest.h>

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
  const Link link{milliseconds(2), milliseconds(3)};
  EXPECT_EQ(cost_of(span(Table::holding_registers, 100), link).time, milliseconds(5) + nanoseconds(16000));
}

TEST(Cost, Requests_of_a_cycle_follow_one_another) {
  const GroupPlan group{10, {span(Table::coils, 8), span(Table::coils, 16)}};
  const Cost cost = cost_of(group, {});
  EXPECT_EQ(cost.requests, 2U);
  EXPECT_EQ(cost.bits, 24U);
  EXPECT_EQ(cost.time, milliseconds(2) + nanoseconds(3 * 80));
}

TEST(Cost, The_load_of_all_rates_adds_up) {
  const Link link{milliseconds(10)};
  const std::vector<GroupPlan> plan{{50, {span(Table::coils, 8)}}, {10, {span(Table::coils, 8)}}};
  EXPECT_NEAR(load(plan, link), 0.6, 0.001);
}

}  // namespace
}  // namespace coupler::plan
