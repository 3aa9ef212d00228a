// SPDX-License-Identifier: Apache-2.0
// Lines whose chip is unplugged, and comes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <vector>

#include "test/device/gpio/wires.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Wires, A_chip_that_comes_back_has_its_outputs_driven_as_before_wherever_it_is) {
  EXPECT_EQ(change_to(two_lamps().add(Table::discrete_inputs, "x", 0, codec::Type::BOOL, at(4))), "");
  EXPECT_TRUE(write(0, 1));
  EXPECT_FALSE(wiring_->reconnect(false)) << "all is well";
  news();
  log_.lines.clear();

  const std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(machine.held.empty());
  EXPECT_FALSE(write(0, 0));
  std::uint16_t level = 0;
  EXPECT_FALSE(wiring_->lines().read(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1), {}));
  EXPECT_FALSE(wiring_->reconnect(false)) << "nothing new";
  EXPECT_THAT(log_.lines,
              ElementsAre(HasSubstr("failed: No such device"), HasSubstr("failed: No such device")));

  machine.chips = chips;
  machine.chips[0].name = "gpiochip3";
  news();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_THAT(news(), ElementsAre("take 0 1", "take 1 0", "take 4"));
  EXPECT_TRUE(write(0, 0));
  EXPECT_TRUE(wiring_->lines().read(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1), {}));
  EXPECT_THAT(log_.lines, Contains(HasSubstr("gpiochip3 line 0, gpiochip3 line 1 works again")));
}

TEST_F(Wires, Of_two_chips_with_the_label_that_come_back_none_is_driven) {
  EXPECT_EQ(change_to(two_lamps()), "");
  std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  chips.push_back(chips[0]);
  chips[1].name = "gpiochip1";
  plug(chips);
  news();
  EXPECT_FALSE(wiring_->reconnect(false));
  EXPECT_THAT(news(), IsEmpty());
  machine.chips.pop_back();
  EXPECT_TRUE(wiring_->reconnect(false)) << "there is one";
}

TEST_F(Wires, An_output_is_known_to_be_unplugged_from_the_first_call_that_says_so) {
  EXPECT_EQ(change_to(two_lamps()), "");
  const auto are_plugged = [&] { return wiring_->lines().are_plugged(modbus::Range::of(0, 2)); };
  unplug();
  EXPECT_TRUE(are_plugged()) << "the kernel is not asked, which takes memory";
  EXPECT_FALSE(write(0, 1));
  EXPECT_FALSE(are_plugged());
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_FALSE(are_plugged());
}

TEST_F(Wires, After_the_watchdog_it_comes_back_safe) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  const std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(true));
  plug(chips);
  news();
  EXPECT_TRUE(wiring_->reconnect(true));
  EXPECT_THAT(news(), ElementsAre("take 0 0", "take 1 1"));
}

TEST_F(Wires, A_safe_state_that_an_unplugged_chip_missed_is_what_it_comes_back_with) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  const std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_FALSE(wiring_->lines().drive_safe());
  plug(chips);
  news();
  EXPECT_TRUE(wiring_->reconnect(false)) << "the watchdog may be idle, or fed again, by now";
  EXPECT_THAT(news(), ElementsAre("take 0 0", "take 1 1"));
}

TEST_F(Wires, What_another_process_wants_while_the_chip_comes_back_is_driven_when_that_has_ended) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  const std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  std::array<int, 2> is_back{};
  ASSERT_EQ(::pipe(is_back.data()), 0);
  const pid_t serves = ::fork();
  if (serves == 0) {
    char byte = 0;
    std::uint16_t off = 0;
    const bool told = ::read(is_back[0], &byte, 1) == 1;
    ::_exit(told && wiring_->lines().drive_each(modbus::Range::of(0, 1), {&off, 1}) ? 0 : 1);
  }
  plug(chips);
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_EQ(machine.levels[0], 1);
  EXPECT_EQ(::write(is_back[1], "x", 1), 1);
  int status = -1;
  ASSERT_EQ(::waitpid(serves, &status, 0), serves);
  EXPECT_EQ(status, 0);
  wiring_->settle();
  EXPECT_EQ(machine.levels[0], 0);
  news();
  wiring_->settle();
  EXPECT_THAT(news(), IsEmpty()) << "once";
  for (const int end : is_back) ::close(end);
}

TEST_F(Wires, Outputs_that_are_to_be_held_are_safe_on_an_unplugged_chip_too) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::hold))), "");
  unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(wiring_->lines().drive_safe());
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("failed: No such device")));
}

}  // namespace
}  // namespace coupler::device
