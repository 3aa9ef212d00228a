// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;
using test::OnePoint;

TEST(Line, It_is_a_name_or_a_chip_and_an_offset) {
  const OnePoint named("coils", "{address: 0, line: GPIO17}");
  EXPECT_EQ(named->line.name, "GPIO17");
  EXPECT_TRUE(named->line.chip.empty());
  const OnePoint placed("coils", "{address: 0, line: {chip: /dev/gpiochip0, offset: 017}}");
  EXPECT_EQ(placed->line.chip, "/dev/gpiochip0");
  EXPECT_EQ(placed->line.offset, 17U);
  EXPECT_TRUE(placed->line.name.empty());
  EXPECT_EQ(OnePoint("coils", "{address: 0, line: {name: GPIO17}}")->line.name, "GPIO17");
}

TEST(Line, An_output_is_pushed_and_pulled_and_safe_when_off_by_default) {
  const OnePoint point("coils", "{address: 0, line: GPIO17}");
  EXPECT_FALSE(point->line.active_low);
  EXPECT_EQ(point->line.bias, Bias::as_is);
  EXPECT_EQ(point->line.drive, Drive::push_pull);
  EXPECT_EQ(point->safe, Safe::off);
}

TEST(Line, Its_options_stand_beside_it) {
  const OnePoint output(
      "coils", "{address: 0, line: GPIO17, active_low: true, bias: pull_up, drive: open_source, safe: hold}");
  EXPECT_TRUE(output->line.active_low);
  EXPECT_EQ(output->line.bias, Bias::pull_up);
  EXPECT_EQ(output->line.drive, Drive::open_source);
  EXPECT_EQ(output->safe, Safe::hold);
  const OnePoint input("discrete_inputs", "{address: 0, line: GPIO17, bias: none, debounce: 1500us}");
  EXPECT_EQ(input->line.bias, Bias::none);
  EXPECT_EQ(input->line.debounce, 1500us);
}

TEST(Line, Its_options_may_stand_inside_it) {
  const OnePoint output(
      "coils",
      "{address: 0, safe: on, line: {name: GPIO17, active_low: yes, bias: pull_down, drive: open_drain}}");
  EXPECT_TRUE(output->line.active_low);
  EXPECT_EQ(output->line.bias, Bias::pull_down);
  EXPECT_EQ(output->line.drive, Drive::open_drain);
  EXPECT_EQ(output->safe, Safe::on);
  const OnePoint input("discrete_inputs", "{address: 0, line: {chip: gpiochip1, offset: 0, debounce: 5ms}}");
  EXPECT_EQ(input->line.debounce, 5ms);
}

TEST(Line, The_same_offset_of_two_chips_is_two_lines) {
  const MapPtr owned = test::load_clean(test::map_of("coils",
                                                     "a: {address: 0, line: {chip: gpiochip0, offset: 1}}, "
                                                     "b: {address: 1, line: {chip: gpiochip1, offset: 1}}"));
  EXPECT_EQ(owned->map().points.size(), 2U);
}

}  // namespace
}  // namespace coupler
