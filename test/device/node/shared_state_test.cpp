// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "coupler/device/node/shared_state.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Range;

constexpr auto holding = Table::holding_registers;

std::uint16_t& cell(SharedState& state, Table table, std::uint16_t address) {
  return state.image().find(table, Range::of(address, 1))[0];
}

TEST(NodeMemory, A_process_that_dies_leaves_what_it_knew) {
  const MapPtr map = MapBuilder().many(holding, 0, 2).build();
  SharedState state(map->map(), {});
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    cell(state, holding, 1) = 77;
    state.statistics().events_lost = 3;
    ::kill(::getpid(), SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(cell(state, holding, 1), 77);
  EXPECT_EQ(state.statistics().events_lost, 3U);
}

TEST(NodeMemory, A_node_tells_which_machine_it_was_started_on) {
  const MapPtr map = MapBuilder().build();
  SharedState state(map->map(), {}, identity::machine_of("cell-7", 7));
  EXPECT_EQ(identity::hostname_of(state.machine()), "cell-7");
  EXPECT_EQ(state.machine().serial, 7U);
}

TEST(NodeMemory, Values_of_points_that_mean_the_same_go_over_wherever_they_stand) {
  const auto bit = [](std::uint8_t number) { return [=](Point& p) { p.format.bit = number; }; };
  const MapPtr old_map = MapBuilder()
                             .add(holding, "level", 0, Type::UDINT)
                             .add(holding, "narrow", 2, Type::INT)
                             .add(holding, "flag", 3, Type::BOOL, bit(3))
                             .add(holding, "moved_flag", 3, Type::BOOL, bit(4))
                             .add(Table::coils, "gone", 0, Type::BOOL)
                             .build();
  MapBuilder builder;
  const auto one = builder.keep({1});
  const MapPtr new_map = builder.add(holding, "level", 10, Type::UDINT)
                             .add(holding, "narrow", 12, Type::UINT)
                             .add(holding, "flag", 13, Type::BOOL, bit(3))
                             .add(holding, "moved_flag", 13, Type::BOOL, bit(5))
                             .add(Table::coils, "fresh", 0, Type::BOOL, [=](Point& p) { p.initial = one; })
                             .build();
  SharedState before(old_map->map(), TimePoint(std::chrono::seconds(5)));
  cell(before, holding, 0) = 0x1234;
  cell(before, holding, 1) = 0x5678;
  cell(before, holding, 2) = 9;
  cell(before, holding, 3) = 0b11000;
  before.statistics().requests = 42;

  SharedState after(new_map->map(), TimePoint(std::chrono::seconds(9)));
  after.prepare_take_over(before);
  after.take_over(before, TimePoint(std::chrono::seconds(9)));
  EXPECT_EQ(cell(after, holding, 10), 0x1234);
  EXPECT_EQ(cell(after, holding, 11), 0x5678);
  EXPECT_EQ(cell(after, holding, 12), 0) << "another type: another meaning";
  EXPECT_EQ(cell(after, holding, 13), 0b1000) << "a bit that moved is another bit";
  EXPECT_EQ(cell(after, Table::coils, 0), 1) << "what is new has its initial value";
  EXPECT_EQ(after.statistics().requests, 42U);
  EXPECT_EQ(after.statistics().started, TimePoint(std::chrono::seconds(5)));
}

TEST(NodeMemory, What_nobody_can_change_is_as_the_new_map_says) {
  constexpr auto inputs = Table::input_registers;
  const auto with_version = [](std::uint16_t version) {
    MapBuilder builder;
    const auto initial = builder.keep({version});
    return builder.add(inputs, "version", 0, Type::UINT, [=](Point& p) { p.initial = initial; })
        .add(inputs, "presses", 1, Type::UINT, [](Point& p) { p.counter.input = "button"; })
        .build();
  };
  const MapPtr old_map = with_version(3);
  const MapPtr new_map = with_version(4);
  SharedState before(old_map->map(), {});
  cell(before, inputs, 1) = 9;
  SharedState after(new_map->map(), {});
  after.prepare_take_over(before);
  after.take_over(before, {});
  EXPECT_EQ(cell(after, inputs, 0), 4);
  EXPECT_EQ(cell(after, inputs, 1), 9) << "a counter goes on";
}

/// Begins to drive the range, in another process that dies then.
void begin(SharedState& state, Table table, Range range) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    OutputSchedule schedule(state.scheduled());
    const std::vector<std::uint8_t> on(100, 0xFF);
    modbus::ScheduleOutput wanted;
    wanted.range = range;
    wanted.values = on;
    ScheduledOutput* which = schedule.add(wanted, table, TimePoint(std::chrono::seconds(1)), ClientSession{});
    schedule.begin(*which, TimePoint(std::chrono::seconds(2)), state.image().find(table, range));
    ::kill(::getpid(), SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
}

TEST(NodeMemory, A_duration_that_has_begun_outlives_its_process) {
  const MapPtr map = MapBuilder().many(Table::coils, 0, 4).build();
  SharedState state(map->map(), {});
  begin(state, Table::coils, Range::of(1, 2));
  OutputSchedule schedule(state.scheduled());
  EXPECT_EQ(schedule.earliest(), TimePoint(std::chrono::seconds(2)));
  const ScheduledOutput* begun = schedule.due(TimePoint::max());
  ASSERT_NE(begun, nullptr);
  EXPECT_EQ(begun->range, Range::of(1, 2));
}

TEST(NodeMemory, A_duration_goes_on_with_another_map_if_all_its_points_are_where_they_were) {
  const MapPtr old_map =
      MapBuilder().coil("a", 0).coil("b", 1).coil("c", 2).coil("d", 3).coil("e", 4).build();
  const MapPtr new_map =
      MapBuilder().coil("a", 0).coil("b", 1).coil("c", 5).coil("new", 2).coil("e", 4).build();
  SharedState before(old_map->map(), {});
  for (std::uint16_t first = 0; first < 5; ++first) begin(before, Table::coils, Range::of(first, 1));
  begin(before, Table::coils, Range::of(0, 2));
  begin(before, Table::coils, Range::of(0, 3));
  SharedState after(new_map->map(), {});
  after.prepare_take_over(before);
  std::vector<bool> fits;
  for (const ScheduledOutput& one : before.scheduled().first(7)) fits.push_back(after.fits(one, before));
  EXPECT_THAT(fits, testing::ElementsAre(true, true, false, false, true, true, false));
  after.take_over(before, {});
  std::vector<Range> ranges;
  OutputSchedule(after.scheduled()).each_begun([&](const ScheduledOutput& one) {
    ranges.push_back(one.range);
  });
  EXPECT_THAT(ranges,
              testing::ElementsAre(Range::of(0, 1), Range::of(1, 1), Range::of(4, 1), Range::of(0, 2)));
}

TEST(NodeMemory, A_duration_does_not_go_on_with_other_hardware_behind_its_points) {
  const auto line = [](const char* name) { return [=](Point& point) { point.line.name = name; }; };
  const auto pwm = [](std::uint16_t channel) {
    return [=](Point& point) { point.pwm = {"pwmchip0", channel, std::chrono::milliseconds(1)}; };
  };
  const auto map = [&](const char* name, std::uint16_t channel) {
    return MapBuilder()
        .add(Table::coils, "lamp", 0, Type::BOOL, line("GPIO5"))
        .add(Table::coils, "relay", 1, Type::BOOL, line(name))
        .add(holding, "valve", 0, Type::UINT, pwm(channel))
        .build();
  };
  const MapPtr old_map = map("GPIO6", 0);
  const MapPtr new_map = map("GPIO7", 1);
  SharedState before(old_map->map(), {});
  begin(before, Table::coils, Range::of(0, 1));
  begin(before, Table::coils, Range::of(1, 1));
  begin(before, holding, Range::of(0, 1));
  SharedState after(new_map->map(), {});
  after.prepare_take_over(before);
  std::vector<bool> fits;
  for (const ScheduledOutput& one : before.scheduled().first(3)) fits.push_back(after.fits(one, before));
  EXPECT_THAT(fits, testing::ElementsAre(true, false, false));
}

TEST(NodeMemory, The_watchdog_waits_anew_and_what_expired_stays_expired) {
  const auto with_timeout = [](int ms) {
    return MapBuilder()
        .many(Table::coils, 0, 1)
        .watchdog({std::chrono::milliseconds(ms), Watchdog::FedBy::any, Watchdog::Recovery::manual})
        .build();
  };
  const MapPtr quick = with_timeout(100);
  const MapPtr slow = with_timeout(500);
  const TimePoint now(std::chrono::seconds(1));
  SharedState before(quick->map(), now);
  before.watchdog().arm(now);
  SharedState after(slow->map(), now);
  after.prepare_take_over(before);
  after.take_over(before, now + std::chrono::milliseconds(50));
  EXPECT_EQ(after.watchdog().left(now), std::chrono::milliseconds(550));

  before.watchdog().expire(true, now);
  after.prepare_take_over(before);
  after.take_over(before, now);
  EXPECT_TRUE(after.watchdog().is_locked());

  const MapPtr none = MapBuilder().many(Table::coils, 0, 1).build();
  SharedState without(none->map(), now);
  without.prepare_take_over(before);
  without.take_over(before, now);
  EXPECT_FALSE(without.watchdog().is_present());
}

}  // namespace
}  // namespace coupler::device
