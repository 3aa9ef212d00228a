// SPDX-License-Identifier: Apache-2.0
// The difference of two wirings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/gpio/wires.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Wires, The_same_map_again_touches_nothing) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  news();
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(news(), ElementsAre("prepared"));
  std::uint16_t level = 0;
  EXPECT_TRUE(wiring_->lines().driven(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1)));
  EXPECT_EQ(level, 1);
}

TEST_F(Wires, A_new_line_is_requested_first_and_a_line_that_leaves_alone_is_released_in_its_safe_state) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::on))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "b", 0, codec::Type::BOOL, at(1))), "");
  EXPECT_THAT(news(), ElementsAre("take 1 0", "prepared", "drive 0 1", "release 0"));
  EXPECT_THAT(log_.lines, IsEmpty());
}

TEST_F(Wires, A_line_that_leaves_others_behind_stays_held_safe_and_can_come_back) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 5, codec::Type::BOOL, at(0))), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 1"));
  EXPECT_THAT(log_.lines,
              ElementsAre(HasSubstr("gpiochip0 line 1 is not in the map any more, but stays held")));
  EXPECT_TRUE(write(5, 0)) << "its new address";
  EXPECT_TRUE(write(5, 1));
  EXPECT_TRUE(wiring_->lines().drive_safe());
  news();
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 0")) << "to its initial level";
}

TEST_F(Wires, After_the_watchdog_new_outputs_begin_safe) {
  const auto initially_on = [](unsigned offset, Safe safe) {
    return [=](Point& p) {
      static constexpr std::uint16_t on = 1;
      at(offset, safe)(p);
      p.initial = Span<const std::uint16_t>(&on, 1);
    };
  };
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  EXPECT_EQ(machine.levels[1], 1) << "idle, and safe";
  news();
  EXPECT_EQ(change_to(two_lamps()
                          .add(Table::coils, "c", 2, codec::Type::BOOL, initially_on(2, Safe::off))
                          .add(Table::coils, "d", 3, codec::Type::BOOL, initially_on(3, Safe::hold))
                          .add(Table::coils, "e", 4, codec::Type::BOOL, at(4, Safe::on)),
                      true),
            "");
  EXPECT_THAT(news(), ElementsAre("take 2 0", "take 3 1", "take 4 1", "prepared"));
}

TEST_F(Wires, After_the_watchdog_an_output_that_moves_to_another_line_begins_safe_there) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(1, Safe::on)), true), "");
  EXPECT_THAT(news(), ElementsAre("take 1 1", "prepared", "release 0"));
}

TEST_F(Wires, What_cannot_be_had_leaves_everything_as_it_is) {
  EXPECT_EQ(change_to(two_lamps()), "");
  news();
  machine.refused = {3};
  EXPECT_THAT(change_to(two_lamps()
                            .add(Table::coils, "c", 2, codec::Type::BOOL, at(2, Safe::off, true))
                            .add(Table::discrete_inputs, "d", 0, codec::Type::BOOL, at(3))),
              HasSubstr("busy: gpiochip0 line 3"));
  EXPECT_THAT(news(), ElementsAre("take 2 0", "release 2"));
  EXPECT_TRUE(write(1, 1)) << "the old wiring works";
}

TEST_F(Wires, The_settings_of_an_output_change_only_without_others_beside_it) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(change_to(MapBuilder()
                            .add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))
                            .add(Table::coils, "b", 1, codec::Type::BOOL, at(1))),
              AllOf(HasSubstr("point 'a'"), HasSubstr("restart the node")));
  news();
  EXPECT_EQ(change_to(MapBuilder()
                          .add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))
                          .add(Table::coils, "b", 1, codec::Type::BOOL, at(1, Safe::off, true))),
            "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 1", "release 0", "release 1", "take 0 0", "take 1 0"));
}

TEST_F(Wires, Inputs_are_requested_anew_if_one_of_their_request_changes) {
  const auto inputs = [](bool low) {
    return MapBuilder()
        .add(Table::discrete_inputs, "x", 0, codec::Type::BOOL, at(4))
        .add(Table::discrete_inputs, "y", 1, codec::Type::BOOL, at(5, Safe::off, low));
  };
  EXPECT_EQ(change_to(inputs(false)), "");
  news();
  EXPECT_EQ(change_to(inputs(true)), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "release 4", "release 5", "take 4", "take 5"));
}

TEST_F(Wires, A_line_that_changes_sides_is_safe_and_released_before) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::on))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::discrete_inputs, "a", 0, codec::Type::BOOL, at(0))), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 0 1", "release 0", "take 0"));
}

TEST_F(Wires, What_the_kernel_takes_back_only_later_is_told_and_tried_again) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  machine.refused = {0};
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))), "");
  EXPECT_THAT(log_.lines, Contains(HasSubstr("busy: gpiochip0 line 0")));
  EXPECT_FALSE(write(0, 1));
  machine.refused.clear();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(write(0, 1));
}

}  // namespace
}  // namespace coupler::device
