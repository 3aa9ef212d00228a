// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>
#include <vector>

#include "coupler/device/gpio/simulated_chip.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Range;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Levels = std::vector<std::uint16_t>;

constexpr Table coils = Table::coils;
constexpr Table inputs = Table::discrete_inputs;

Levels read(SimulatedChip& chip, unsigned start, unsigned count, TimePoint now = {}) {
  Levels levels(count, 9);
  EXPECT_TRUE(chip.read(Range::of(start, count), levels, now));
  return levels;
}

TEST(SimulatedChip, A_wire_shows_the_output_at_the_input_inverted_if_the_map_says_so) {
  const auto map = MapBuilder()
                       .add(coils, "out", 5, Type::BOOL)
                       .add(inputs, "same", 0, Type::BOOL)
                       .add(inputs, "opposite", 1, Type::BOOL)
                       .wire("out", "same")
                       .wire("out", "opposite", true)
                       .build();
  SimulatedChip chip(map->map(), {});
  EXPECT_EQ(read(chip, 0, 2), Levels({0, 1}));
  EXPECT_TRUE(chip.drive(Range::of(5, 1), Levels{1}));
  EXPECT_EQ(read(chip, 0, 2), Levels({1, 0}));
  EXPECT_EQ(read(chip, 1, 1), Levels({0}));
}

TEST(SimulatedChip, A_square_wave_is_on_for_the_first_half_of_its_period) {
  const auto map =
      MapBuilder().add(inputs, "clock", 3, Type::BOOL).square("clock", milliseconds(100)).build();
  const TimePoint start{std::chrono::hours(5)};
  SimulatedChip chip(map->map(), start);
  EXPECT_EQ(read(chip, 3, 1, start), Levels({1}));
  EXPECT_EQ(read(chip, 3, 1, start + milliseconds(49)), Levels({1}));
  EXPECT_EQ(read(chip, 3, 1, start + milliseconds(50)), Levels({0}));
  EXPECT_EQ(read(chip, 3, 1, start + milliseconds(99)), Levels({0}));
  EXPECT_EQ(read(chip, 3, 1, start + milliseconds(1000)), Levels({1}));
}

TEST(SimulatedChip, An_input_with_no_wire_has_its_initial_level_until_it_is_pulled) {
  MapBuilder builder;
  const auto on = builder.keep({1});
  const auto map = builder
                       .add(inputs, "a", 0, Type::BOOL,
                            [&](Point& p) {
                              p.initial = on;
                              p.line.name = "A";
                            })
                       .add(inputs, "b", 1, Type::BOOL, [](Point& p) { p.line.name = "B"; })
                       .build();
  SimulatedChip chip(map->map(), {});
  EXPECT_EQ(read(chip, 0, 2), Levels({1, 0}));
  chip.pull("a", false);
  chip.pull("b", true);
  EXPECT_EQ(read(chip, 0, 2), Levels({0, 1}));
}

TEST(SimulatedChip, Several_inputs_are_pulled_at_once_unless_one_follows_a_wire) {
  const auto lined = [](Point& point) { point.line.name = "L"; };
  const auto map = MapBuilder()
                       .coil("lamp", 0)
                       .add(inputs, "a", 0, Type::BOOL, lined)
                       .add(inputs, "b", 1, Type::BOOL, lined)
                       .add(inputs, "c", 2, Type::BOOL, lined)
                       .wire("lamp", "c")
                       .build();
  SimulatedChip chip(map->map(), {});
  EXPECT_TRUE(chip.pull(Range::of(0, 2), Levels{0, 1}));
  EXPECT_EQ(read(chip, 0, 3), Levels({0, 1, 0}));
  EXPECT_FALSE(chip.pull(Range::of(0, 3), Levels{1, 0, 1}));
  EXPECT_EQ(read(chip, 0, 3), Levels({0, 1, 0}));
  chip.plug(false);
  EXPECT_FALSE(chip.pull(Range::of(0, 1), Levels{1}));
}

TEST(SimulatedChip, An_input_with_neither_line_nor_wire_is_left_as_it_is) {
  const auto map = MapBuilder().input("a", 0).input("b", 1).square("b", milliseconds(100)).build();
  SimulatedChip chip(map->map(), {});
  Levels levels{7, 7};
  EXPECT_TRUE(chip.read(Range::of(0, 2), levels, {}));
  EXPECT_EQ(levels, Levels({7, 1}));
}

TEST(SimulatedChip, Outputs_begin_with_their_initial_level_and_end_in_their_safe_state) {
  MapBuilder builder;
  const auto on = builder.keep({1});
  const auto second_only = builder.keep({0, 1});
  const auto safe = [](Safe state) { return [state](Point& p) { p.safe = state; }; };
  const auto map = builder.add(coils, "lit", 0, Type::BOOL, [&](Point& p) { p.initial = on; })
                       .add(coils, "safe_on", 1, Type::BOOL, safe(Safe::on))
                       .add(coils, "held", 2, Type::BOOL, safe(Safe::hold))
                       .add(coils, "array", 3, Type::BOOL,
                            [&](Point& p) {
                              p.count = 2;
                              p.safe = Safe::on;
                              p.safe_value = second_only;
                            })
                       .build();
  SimulatedChip chip(map->map(), {});
  EXPECT_TRUE(chip.level("lit"));
  EXPECT_FALSE(chip.level("safe_on"));
  EXPECT_TRUE(chip.drive(Range::of(0, 4), Levels{1, 0, 1, 1}));
  EXPECT_TRUE(chip.drive_safe());
  EXPECT_FALSE(chip.level("lit"));
  EXPECT_TRUE(chip.level("safe_on"));
  EXPECT_TRUE(chip.level("held"));
  EXPECT_FALSE(chip.level("array"));
}

using Change = std::tuple<std::uint16_t, bool, TimePoint>;

/// Adds up what it is told.
class Total : public EdgeSink {
 public:
  void add(std::uint16_t input, const Edges& edges) override {
    all[input].rising += edges.rising;
    all[input].falling += edges.falling;
  }
  void changed(std::uint16_t input, bool level, TimePoint at) override {
    changes.emplace_back(input, level, at);
  }
  void lost(std::uint32_t count) override { lost_changes += count; }
  std::map<std::uint16_t, Edges> all;
  std::vector<Change> changes;
  std::uint32_t lost_changes = 0;
};

TEST(SimulatedChip, The_edges_of_a_square_wave_are_computed_however_rarely_they_are_asked_for) {
  using namespace std::chrono_literals;
  const auto map = MapBuilder().add(inputs, "clock", 7, Type::BOOL).square("clock", 1ms).build();
  const TimePoint start{1h};
  SimulatedChip chip(map->map(), start);
  Total total;
  chip.take_edges(start + 499us, total);
  EXPECT_EQ(total.all.count(7), 0U) << "it is on from the start";
  chip.take_edges(start + 500us, total);
  EXPECT_EQ(total.all[7].falling, 1U);
  EXPECT_EQ(total.all[7].rising, 0U);
  chip.take_edges(start + 1h + 1ms, total);
  EXPECT_EQ(total.all[7].rising, 3600001U);
  EXPECT_EQ(total.all[7].falling, 3600001U);
}

TEST(SimulatedChip, Every_write_to_an_output_is_an_edge_of_the_inputs_wired_to_it) {
  const auto map = MapBuilder()
                       .add(coils, "out", 0, Type::BOOL)
                       .add(inputs, "same", 0, Type::BOOL)
                       .add(inputs, "opposite", 1, Type::BOOL)
                       .wire("out", "same")
                       .wire("out", "opposite", true)
                       .build();
  SimulatedChip chip(map->map(), {});
  for (const auto& levels : {Levels{1}, Levels{1}, Levels{0}, Levels{1}})
    EXPECT_TRUE(chip.drive(Range::of(0, 1), levels));
  Total total;
  chip.take_edges({}, total);
  EXPECT_EQ(total.all[0].rising, 2U);
  EXPECT_EQ(total.all[0].falling, 1U);
  EXPECT_EQ(total.all[1].rising, 1U);
  EXPECT_EQ(total.all[1].falling, 2U);
}

TEST(SimulatedChip, The_changes_of_a_square_wave_have_their_own_times) {
  using namespace std::chrono_literals;
  const auto map = MapBuilder().add(inputs, "clock", 7, Type::BOOL).square("clock", 10ms).build();
  const TimePoint start{1h};
  SimulatedChip chip(map->map(), start);
  Total total;
  EXPECT_EQ(chip.next_change(start), start + 5ms);
  chip.take_edges(start + 21ms, total);
  EXPECT_THAT(total.changes, ElementsAre(Change(7, false, start + 5ms), Change(7, true, start + 10ms),
                                         Change(7, false, start + 15ms), Change(7, true, start + 20ms)));
  EXPECT_EQ(chip.next_change(start + 21ms), start + 25ms);
  chip.take_edges(start + 22ms, total);
  EXPECT_EQ(total.changes.size(), 4U) << "each is told once";
}

TEST(SimulatedChip, Of_very_many_changes_the_newest_are_told_and_none_is_unaccounted) {
  using namespace std::chrono_literals;
  const auto map = MapBuilder().add(inputs, "clock", 7, Type::BOOL).square("clock", 10ms).build();
  const TimePoint start{1h};
  SimulatedChip chip(map->map(), start);
  Total total;
  chip.take_edges(start + 10s, total);
  ASSERT_EQ(total.changes.size(), std::size_t{SimulatedChip::most_changes});
  EXPECT_EQ(total.changes.back(), Change(7, true, start + 10s));
  EXPECT_EQ(total.changes.front(), Change(7, false, start + 10s - 5ms * (SimulatedChip::most_changes - 1)));
  EXPECT_EQ(total.changes.size() + total.lost_changes, 2000U);
}

TEST(SimulatedChip, The_first_change_behind_lost_ones_brings_another_level_than_was_told_last) {
  const auto map = MapBuilder()
                       .add(coils, "out", 0, Type::BOOL)
                       .add(inputs, "in", 0, Type::BOOL)
                       .wire("out", "in")
                       .build();
  SimulatedChip chip(map->map(), {});
  constexpr std::uint32_t made = SimulatedChip::most_changes + 1;
  for (std::uint32_t i = 0; i < made; ++i) EXPECT_TRUE(chip.drive(Range::of(0, 1), Levels{i % 2 == 0}));
  Total total;
  chip.take_edges({}, total);
  EXPECT_EQ(total.changes.front(), Change(0, true, {}));
  EXPECT_EQ(total.changes.back(), Change(0, true, {}));
  EXPECT_EQ(total.changes.size() + total.lost_changes, made);
}

TEST(SimulatedChip, Changes_that_a_write_makes_wait_to_be_told) {
  const auto map = MapBuilder()
                       .add(coils, "out", 0, Type::BOOL)
                       .add(inputs, "opposite", 1, Type::BOOL)
                       .wire("out", "opposite", true)
                       .build();
  SimulatedChip chip(map->map(), {});
  const TimePoint now{milliseconds(5)};
  EXPECT_EQ(chip.next_change(now), std::nullopt);
  EXPECT_TRUE(chip.drive(Range::of(0, 1), Levels{1}));
  EXPECT_TRUE(chip.drive(Range::of(0, 1), Levels{0}));
  EXPECT_EQ(chip.next_change(now), now);
  Total total;
  chip.take_edges(now, total);
  EXPECT_THAT(total.changes, ElementsAre(Change(1, false, now), Change(1, true, now)));
  EXPECT_EQ(chip.next_change(now), std::nullopt);
}

TEST(SimulatedChip, Plugged_in_again_it_tells_what_is_another_level_now) {
  using namespace std::chrono_literals;
  const auto line = [](Point& p) { p.line.name = p.name; };
  const auto map = MapBuilder()
                       .add(inputs, "a", 0, Type::BOOL, line)
                       .add(inputs, "b", 1, Type::BOOL, line)
                       .add(inputs, "clock", 2, Type::BOOL)
                       .square("clock", 10ms)
                       .build();
  const TimePoint start{1h};
  SimulatedChip chip(map->map(), start);
  Total total;
  chip.plug(false);
  chip.pull("a", true);
  chip.pull("b", true);
  chip.pull("b", false);
  chip.take_edges(start + 100ms, total);
  EXPECT_EQ(chip.next_change(start + 100ms), std::nullopt);
  EXPECT_THAT(total.changes, IsEmpty()) << "nobody knows";
  chip.plug(true);
  chip.take_edges(start + 205ms, total);
  EXPECT_THAT(total.changes, ElementsAre(Change(0, true, start + 205ms), Change(2, false, start + 205ms)));
  chip.take_edges(start + 206ms, total);
  EXPECT_EQ(total.changes.size(), 2U);
}

TEST(SimulatedChip, Unplugged_it_refuses_everything_and_changes_nothing) {
  const auto map = MapBuilder().add(coils, "out", 0, Type::BOOL).add(inputs, "in", 0, Type::BOOL).build();
  SimulatedChip chip(map->map(), {});
  chip.plug(false);
  Levels levels(1);
  EXPECT_FALSE(chip.read(Range::of(0, 1), levels, {}));
  EXPECT_FALSE(chip.drive(Range::of(0, 1), Levels{1}));
  chip.plug(true);
  EXPECT_FALSE(chip.level("out"));
}

}  // namespace
}  // namespace coupler::device
