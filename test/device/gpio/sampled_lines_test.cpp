// SPDX-License-Identifier: Apache-2.0
// Inputs that cannot be watched: they report no edges, or there are too many.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "test/device/gpio/wires.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MapBuilder three_inputs() {
  return MapBuilder()
      .add(Table::discrete_inputs, "x", 0, codec::Type::BOOL, at(4))
      .add(Table::discrete_inputs, "y", 1, codec::Type::BOOL, at(5))
      .add(Table::discrete_inputs, "z", 2, codec::Type::BOOL, at(6));
}

TEST_F(Wires, An_input_that_reports_no_edges_is_looked_at_and_told_in_the_log) {
  machine.silent = {5};
  EXPECT_EQ(change_to(three_inputs()), "");
  std::vector<std::string> held;
  for (const std::string& what : news())
    if (what != "release 4" && what != "release 6") held.push_back(what);
  EXPECT_THAT(held, ElementsAre("take 4", "take 6", "take 4", "take 6", "take to look at 5", "prepared"));
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("gpiochip0 line 5: "), HasSubstr("every 5 ms"))));
  const TimePoint now = TimePoint::clock::now();
  EXPECT_NE(wiring_->lines().next_change(now), std::nullopt);
}

TEST_F(Wires, One_that_is_counted_is_refused) {
  machine.silent = {5};
  EXPECT_THAT(change_to(three_inputs().add(Table::input_registers, "count", 0, codec::Type::UINT,
                                           [](Point& p) { p.counter.input = "y"; })),
              HasSubstr("no edges: gpiochip0 line 5"));
}

TEST_F(Wires, Inputs_beyond_what_can_be_watched_are_looked_at) {
  machine.watched = 1;
  EXPECT_EQ(change_to(three_inputs()), "");
  EXPECT_THAT(news(), ElementsAre("take 4", "take to look at 5", "take to look at 6", "prepared"));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("gpiochip0 line 5, gpiochip0 line 6: ")));
  log_.lines.clear();
  EXPECT_EQ(change_to(three_inputs()), "");
  EXPECT_THAT(news(), ElementsAre("prepared")) << "the same map again touches nothing";
  EXPECT_THAT(log_.lines, IsEmpty());
}

TEST_F(Wires, They_come_back_as_they_were) {
  machine.silent = {4, 5, 6};
  EXPECT_EQ(change_to(three_inputs()), "");
  const std::vector<Chip> chips = unplug();
  EXPECT_TRUE(wiring_->reconnect(false));
  plug(chips);
  news();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_THAT(news(), ElementsAre("take to look at 4", "take to look at 5", "take to look at 6"));
}

}  // namespace
}  // namespace coupler::device
