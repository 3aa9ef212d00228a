// SPDX-License-Identifier: Apache-2.0
// Coils that end by themselves.
#include <gmock/gmock.h>

#include "test/device/core/scheduled_outputs.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using modbus::Range;
using std::chrono::milliseconds;
using testing::ElementsAre;

constexpr milliseconds length{200};
constexpr std::uint32_t pulse_epoch = 7;

auto pulsed(Safe safe) {
  return [safe](Point& point) {
    with_line(safe)(point);
    point.pulse = length;
  };
}

/// Coils 0 and 1 have pulses, safe off and hold; 2 has none.
struct Pulse : testing::Test {
  explicit Pulse(std::chrono::milliseconds watchdog = {})
      : node(MapBuilder()
                 .add(Table::coils, "horn", 0, codec::Type::BOOL, pulsed(Safe::off))
                 .add(Table::coils, "ejector", 1, codec::Type::BOOL, pulsed(Safe::hold))
                 .add(Table::coils, "lamp", 2, codec::Type::BOOL, with_line(Safe::off))
                 .watchdog({watchdog, Watchdog::FedBy::any, Watchdog::Recovery::automatic})
                 .build()) {
    node.lines.outputs = {{0, {0, 0}}, {2, {0, 0}}};
    node.now = TimePoint(std::chrono::hours(5));
    node.handler.tell_changes(pulse_epoch, node.now);
  }
  void write(int coil, bool on) { node.ask(pdu(5, {coil, on ? 0xFF00 : 0})); }
  void pass(milliseconds time) {
    node.now += time;
    node.handler.tick(node.now);
  }
  std::uint16_t schedule(milliseconds in, bool on, milliseconds duration = {}) {
    const std::vector<std::uint16_t> bits{on};
    const modbus::ScheduleOutput wanted{
        pulse_epoch, node_time(node.now + in), duration, modbus::Function::read_coils, Range::of(0, 1), {}};
    const auto request = modbus::ScheduleRequest::coils(wanted, bits);
    const auto reply =
        modbus::parse_schedule_reply(node.ask(Pdu(request.pdu().begin(), request.pdu().end())));
    return reply ? reply->number : std::uint16_t{0};
  }
  std::vector<int> levels() const {
    std::vector<int> all;
    for (const std::uint16_t cell : node.image.find(Table::coils, Range::of(0, 3))) all.push_back(cell);
    return all;
  }
  bool runs() const { return node.handler.next_scheduled() != TimePoint::max(); }

  NodeUnderTest node;
};

struct PulseWithWatchdog : Pulse {
  PulseWithWatchdog() : Pulse(milliseconds(100)) {}
};

TEST_F(Pulse, A_1_is_driven_for_so_long_and_not_longer) {
  write(0, true);
  EXPECT_EQ(node.handler.next_scheduled(), node.now + length) << "the board's timer ends it";
  pass(length - milliseconds(1));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  pass(milliseconds(1));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_EQ(node.lines.outputs[0].level, 0);
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, Its_end_is_a_change) {
  write(0, true);
  pass(length);
  const ChangeRing& ring = node.changes.ring();
  ASSERT_EQ(ring.newest(), 2U);
}

TEST_F(Pulse, Another_1_prolongs_it_and_0_ends_it) {
  write(0, true);
  pass(milliseconds(150));
  write(0, true);
  pass(milliseconds(150));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  write(0, false);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, Each_coil_of_a_write_has_its_own_and_others_stay) {
  node.ask(pdu(15, {0, 3}, {1, 0x07}));
  pass(milliseconds(100));
  write(1, true);
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 1));
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 1));
}

TEST_F(Pulse, What_the_hardware_refuses_ends_all_the_same_since_a_line_may_have_moved) {
  node.lines.broken = true;
  write(0, true);
  node.lines.broken = false;
  node.lines.outputs[0].level = 1;
  pass(length);
  EXPECT_EQ(node.lines.outputs[0].level, 0);
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, What_the_hardware_refuses_prolongs_none) {
  write(0, true);
  pass(milliseconds(150));
  node.lines.broken = true;
  write(0, true);
  EXPECT_EQ(node.handler.next_scheduled(), node.now + milliseconds(50));
}

TEST_F(Pulse, An_end_that_the_hardware_refuses_is_tried_again) {
  write(0, true);
  node.lines.stuck = 0;
  pass(length);
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  node.lines.stuck.reset();
  pass(TimedOutputEnd::retry_period);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
}

TEST_F(PulseWithWatchdog, The_safe_state_holds_it_at_most_until_its_end) {
  node.ask(pdu(15, {0, 2}, {1, 0x03}));
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(0, 1, 0));
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
}

TEST_F(Pulse, One_that_is_scheduled_begins_when_it_is_driven) {
  ASSERT_NE(schedule(milliseconds(50), true), 0);
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  pass(length);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
}

TEST_F(Pulse, No_duration_makes_it_longer) {
  ASSERT_NE(schedule(milliseconds(50), true, 3 * length), 0);
  pass(milliseconds(50));
  pass(length);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  pass(2 * length);
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, A_shorter_duration_ends_it) {
  ASSERT_NE(schedule(milliseconds(50), true, milliseconds(50)), 0);
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, A_coil_that_is_on_when_its_node_begins_ends_too) {
  const std::uint16_t on[] = {1};
  NodeUnderTest other(MapBuilder()
                          .add(Table::coils, "horn", 0, codec::Type::BOOL,
                               [&](Point& point) {
                                 point.pulse = length;
                                 point.initial = on;
                               })
                          .build());
  EXPECT_EQ(other.handler.next_scheduled(), TimePoint(length));
  other.handler.tick(TimePoint(length));
  EXPECT_EQ(other.image.find(Table::coils, Range::of(0, 1))[0], 0);
}

TEST_F(Pulse, A_duration_that_interrupts_it_does_not_bring_it_back) {
  write(0, true);
  ASSERT_NE(schedule(milliseconds(50), false, milliseconds(50)), 0);
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  pass(milliseconds(50));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, A_write_during_a_duration_has_its_whole_length) {
  ASSERT_NE(schedule(milliseconds(50), false, milliseconds(100)), 0);
  pass(milliseconds(50));
  write(0, true);
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(1, 0, 0));
  pass(milliseconds(100));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0));
  EXPECT_FALSE(runs());
}

TEST_F(Pulse, It_takes_none_of_the_places_of_clients) {
  node.ask(pdu(15, {0, 2}, {1, 0x03}));
  for (int i = 0; i < 64; ++i) EXPECT_NE(schedule(std::chrono::minutes(1), true), 0);
  EXPECT_EQ(schedule(std::chrono::minutes(1), true), 0);
  pass(length);
  EXPECT_EQ(schedule(std::chrono::minutes(1), true), 0) << "nor gives it them its own";
}

TEST_F(Pulse, The_end_of_the_node_ends_it) {
  node.ask(pdu(15, {0, 2}, {1, 0x03}));
  EXPECT_TRUE(node.handler.make_safe(modbus::Reason::safe_state, node.now));
  EXPECT_THAT(levels(), ElementsAre(0, 0, 0)) << "also one with `safe: hold`";
}

TEST_F(Pulse, Another_process_that_takes_its_memory_ends_it) {
  write(1, true);
  OutputSchedule next(node.scheduled, nullptr, 2);
  EXPECT_EQ(next.earliest(), node.now + length);
}

/// Code that leaves outputs as they are in the safe state.
struct Firmware : Hooks {
  void put_new_values(Image&, Changes&) override {}
  bool accept(std::uint32_t, const std::uint16_t* registers) override {
    level = registers[0];
    return true;
  }
  int level = 0;
};

TEST(PulseOfAFirmware, Ends_after_the_safe_state_too) {
  const MapPtr owner =
      MapBuilder()
          .add(Table::coils, "bell", 0, codec::Type::BOOL, [](Point& point) { point.pulse = length; })
          .watchdog({milliseconds(100), Watchdog::FedBy::any, Watchdog::Recovery::automatic})
          .build();
  const Map& map = owner->map();
  OwnedImage memory(map);
  FakeLines lines;
  Firmware firmware;
  HookedPoints hooked(map, memory.image, firmware);
  Statistics statistics;
  OutputWatchdog watchdog(map.service.watchdog);
  Changes changes;
  std::vector<ScheduledOutput> places(1);
  OutputSchedule schedule(places, nullptr, 1);
  Handler handler(map, Hardware(lines, nullptr, &hooked),
                  {memory.image, statistics, watchdog, {}, changes, schedule});
  ClientSession session;
  std::array<std::uint8_t, modbus::max_pdu_size> reply{};
  const TimePoint begun(std::chrono::hours(1));
  handler.handle(pdu(5, {0, 0xFF00}), session, begun, reply);
  EXPECT_EQ(firmware.level, 1);
  handler.tick(begun + milliseconds(100));
  EXPECT_EQ(watchdog.state(), OutputWatchdog::State::expired);
  handler.tick(begun + length);
  EXPECT_EQ(firmware.level, 0);
}

}  // namespace
}  // namespace coupler::device
