// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/point_description.hpp"

#include <gtest/gtest.h>

#include <array>

#include "coupler/docs/words.hpp"

namespace coupler::docs {
namespace {

using codec::Type;
using namespace std::chrono_literals;

/// A holding register of that type at address 6, to be changed by the test.
Point point_of(codec::Type type) {
  Point point;
  point.name = "level";
  point.table = Table::holding_registers;
  point.address = 6;
  point.format.type = type;
  if (type == codec::Type::STRING) point.format.length = 12;  // no point is without a register
  point.access = Access::read_write;
  return point;
}

TEST(PointDescription, Both_notations_of_a_wide_point_name_its_first_and_last_address) {
  Point point = point_of(Type::REAL);
  EXPECT_EQ(describe(point, 3).address, "6 – 7");
  EXPECT_EQ(describe(point, 3).modicon, "40007 – 40008");
  EXPECT_EQ(describe(point, 3).line, 3);
  point.address = 9999;
  EXPECT_EQ(describe(point, 0).modicon, "410000 – 410001");
}

TEST(PointDescription, A_part_of_a_register_says_which) {
  Point bit = point_of(Type::BOOL);
  bit.format.bit = 12;
  EXPECT_EQ(describe(bit, 0).part, "bit 12");
  Point byte = point_of(Type::USINT);
  byte.format.half = codec::Half::low;
  EXPECT_EQ(describe(byte, 0).part, "low byte");
  EXPECT_EQ(describe(point_of(Type::INT), 0).part, "");
}

TEST(PointDescription, The_order_is_as_long_as_the_value) {
  EXPECT_EQ(describe(point_of(Type::INT), 0).order, "AB");
  EXPECT_EQ(describe(point_of(Type::REAL), 0).order, "ABCD");
  Point coil = point_of(Type::BOOL);
  coil.table = Table::coils;
  EXPECT_EQ(describe(coil, 0).order, "");
}

TEST(PointDescription, Bit_strings_are_in_hexadecimal_with_all_digits) {
  const std::array<std::uint16_t, 2> registers{0x0012, 0xABCD};
  Point point = point_of(Type::DWORD);
  point.initial = registers;
  EXPECT_EQ(describe(point, 0).initial, "0x0012ABCD");
  point.format.type = Type::UDINT;
  EXPECT_EQ(describe(point, 0).initial, "1223629");
}

TEST(PointDescription, The_range_is_that_of_the_published_value) {
  Point point = point_of(Type::INT);
  EXPECT_EQ(describe(point, 0).range, "-32768 … 32767");
  point.scale = {0.1, -40};
  EXPECT_EQ(describe(point, 0).range, "-3316.8 … 3236.7");
  EXPECT_EQ(describe(point, 0).scale, "raw × 0.1 - 40");
  EXPECT_EQ(describe(point_of(Type::ULINT), 0).range, "0 … 18446744073709551615");
  EXPECT_EQ(describe(point_of(Type::STRING), 0).range, "");
  Point duty = point_of(Type::UINT);
  duty.pwm = {"pwmchip0", 1, 40us};
  EXPECT_EQ(describe(duty, 0).range, "0 … 100") << "the channel takes no more";
}

TEST(PointDescription, A_line_says_what_is_unusual_about_it) {
  Point button = point_of(Type::BOOL);
  button.table = Table::discrete_inputs;
  button.line = {"gpiochip0", 4, "", true, Bias::pull_up, Drive::push_pull, 5000us};
  EXPECT_EQ(describe(button, 0).source, "gpiochip0 line 4");
  EXPECT_EQ(describe(button, 0).source_details, "active low, pull-up, debounce 5 ms");
  EXPECT_EQ(describe(button, 0).safe, "") << "an input";
}

TEST(PointDescription, Counters_and_channels_are_what_stands_behind_a_register) {
  Point parts = point_of(Type::UDINT);
  parts.counter = {"barrier", Edge::both};
  EXPECT_EQ(describe(parts, 0).source + ": " + describe(parts, 0).source_details,
            "counter: both edges of barrier");
  Point pressure = point_of(Type::INT);
  pressure.iio = {"ads1015", "voltage0"};
  EXPECT_EQ(describe(pressure, 0).source, "ads1015 voltage0");
}

TEST(PointDescription, The_safe_state_of_an_array_of_coils_is_one_for_all_or_one_each) {
  static const std::uint16_t first_only[] = {1, 0};
  Point lamps = point_of(Type::BOOL);
  lamps.table = Table::coils;
  lamps.count = 2;
  lamps.safe = Safe::on;
  EXPECT_EQ(describe(lamps, 0).safe, "on");
  lamps.safe_value = first_only;
  EXPECT_EQ(describe(lamps, 0).safe, "on, off");
}

TEST(PointDescription, Outputs_with_hardware_have_a_safe_state_others_if_the_map_says_it) {
  Point lamp = point_of(Type::BOOL);
  lamp.table = Table::coils;
  EXPECT_EQ(describe(lamp, 0).safe, "");
  lamp.safe = Safe::on;
  EXPECT_EQ(describe(lamp, 0).safe, "on");
  lamp.safe = Safe::off;
  lamp.line.name = "GPIO17";
  EXPECT_EQ(describe(lamp, 0).safe, "off");
  lamp.safe = Safe::hold;
  EXPECT_EQ(describe(lamp, 0).safe, "hold");
  static const std::uint16_t quarter[] = {250};
  Point fan = point_of(Type::UINT);
  fan.pwm = {"pwmchip0", 1, 40us};
  fan.scale = {0.1, 0};
  EXPECT_EQ(describe(fan, 0).safe, "0");
  fan.safe = Safe::on;
  fan.safe_value = quarter;
  EXPECT_EQ(describe(fan, 0).safe, "25");
}

TEST(PointDescription, Initial_values_are_read_as_they_are_published) {
  static const std::uint16_t words[] = {1, 2, 2};
  static const std::uint16_t same[] = {7, 7};
  Point point = point_of(Type::UINT);
  point.count = 3;
  point.initial = words;
  EXPECT_EQ(describe(point, 0).initial, "1, 2, 2");
  EXPECT_EQ(describe(point, 0).count, "3");
  point.count = 2;
  point.initial = same;
  EXPECT_EQ(describe(point, 0).initial, "7 each");
}

TEST(PointDescription, The_deadman_says_what_is_written_and_when) {
  static const std::uint16_t zero[] = {0};
  Point point = point_of(Type::INT);
  point.host.deadman = {500ms, zero};
  point.host.rate = 2.5;
  EXPECT_EQ(describe(point, 0).deadman, "0 after 500 ms");
  EXPECT_EQ(describe(point, 0).rate, "2.5 Hz");
}

TEST(PointDescription, A_pulse_has_its_length) {
  Point point;
  EXPECT_EQ(describe(point, 0).pulse, "");
  point.pulse = std::chrono::milliseconds(200);
  EXPECT_EQ(describe(point, 0).pulse, "200 ms");
}

TEST(PointDescription, A_priority_is_named_where_it_is_not_the_usual_one) {
  Point point = point_of(Type::INT);
  EXPECT_EQ(describe(point, 0).priority, "");
  point.host.priority = HostOptions::Priority::high;
  EXPECT_EQ(describe(point, 0).priority, "high");
}

TEST(Words, A_duration_has_the_largest_unit_that_needs_no_fraction) {
  EXPECT_EQ(words(2s), "2 s");
  EXPECT_EQ(words(1500ms), "1500 ms");
  EXPECT_EQ(words(40us), "40 µs");
  EXPECT_EQ(words(15ns), "15 ns");
}

}  // namespace
}  // namespace coupler::docs
