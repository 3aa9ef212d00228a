// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/hooks.hpp"

#include <gmock/gmock.h>

#include "coupler/map/image_layout.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Code that refuses one value of one point.
struct FakeHooks : Hooks {
  void put_new_values(Image& image, Changes&) override {
    if (set) image.find(Table::input_registers, modbus::Range::of(0, 1))[0] = *std::exchange(set, {});
  }
  bool accept(std::uint32_t point, const std::uint16_t* registers) override {
    calls.emplace_back(point, registers[0]);
    return calls.back() != refused;
  }
  std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) override {
    if (table == Table::holding_registers && range.contains(unreadable))
      return modbus::Exception::server_device_busy;
    return std::nullopt;
  }
  bool shows_identity() const noexcept override { return is_node; }
  void make_safe() override { ++safe; }

  bool is_node = true;
  std::uint32_t unreadable = 0x10000;  ///< a holding register
  std::optional<std::uint16_t> set;
  std::vector<std::pair<std::uint32_t, std::uint16_t>> calls;
  std::pair<std::uint32_t, std::uint16_t> refused{99, 0};
  int safe = 0;
};

// Points: 0 input a; holding: 1 b, 2 c (two registers), 3 flag (bit 0) and 4 alarm (bit 1) of one register.
struct HookedNode : ::testing::Test {
  Pdu ask(const Pdu& request) {
    std::array<std::uint8_t, modbus::max_pdu_size> reply{};
    const std::size_t size = handler.handle(request, session, now, reply);
    return Pdu(reply.data(), reply.data() + size);
  }
  Pdu write(int address, std::initializer_list<int> values) {
    Pdu bytes{static_cast<std::uint8_t>(2 * values.size())};
    for (const int value : values) {
      bytes.push_back(static_cast<std::uint8_t>(value >> 8));
      bytes.push_back(static_cast<std::uint8_t>(value));
    }
    return ask(pdu(16, {address, static_cast<int>(values.size())}, bytes));
  }

  MapPtr owner =
      fakes::MapBuilder()
          .add(Table::input_registers, "a", 0, Type::UINT)
          .add(Table::holding_registers, "b", 0, Type::UINT)
          .add(Table::holding_registers, "c", 1, Type::UDINT)
          .add(Table::holding_registers, "flag", 3, Type::BOOL)
          .add(Table::holding_registers, "alarm", 3, Type::BOOL, [](Point& point) { point.format.bit = 1; })
          .build();
  const Map& map = owner->map();
  OwnedImage memory{map};
  FakeLines lines;
  FakeHooks hooks;
  HookedPoints hooked{map, memory.image, hooks};
  ClientSession session;
  Statistics statistics;
  TimePoint now{};
  OutputWatchdog watchdog{map.service.watchdog};
  std::vector<EdgePoints::Link> links{node_memory(map).links};
  std::vector<ChangeRing::Entry> ring{4};
  std::vector<std::uint16_t> told = std::vector<std::uint16_t>(memory.image.bits().size());
  Changes changes{memory.image, ring, told};
  std::vector<ScheduledOutput> scheduled{4};
  FakeScheduleSink outcomes;
  OutputSchedule schedule{scheduled, &outcomes};
  Handler handler{
      map, Hardware(lines, nullptr, &hooked), {memory.image, statistics, watchdog, links, changes, schedule}};
};

const Pdu failure{0x90, 4};

TEST_F(HookedNode, A_write_is_acknowledged_after_the_code_accepted_it) {
  EXPECT_EQ(write(0, {7}), (Pdu{16, 0, 0, 0, 1}));
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(1U, 7)));
  EXPECT_EQ(ask(pdu(3, {0, 1})), (Pdu{3, 2, 0, 7}));
}

TEST_F(HookedNode, A_refused_value_is_exception_04_and_changes_nothing) {
  hooks.refused = {1, 7};
  EXPECT_EQ(write(0, {7}), failure);
  EXPECT_EQ(ask(pdu(3, {0, 1})), (Pdu{3, 2, 0, 0}));
}

TEST_F(HookedNode, What_the_code_refuses_when_it_is_due_is_told_as_failed_and_changes_nothing) {
  handler.tell_changes(7, now);
  const auto due = now + std::chrono::milliseconds(5);
  const auto request = modbus::ScheduleRequest::registers(
      {7, node_time(due), {}, modbus::Function::read_holding_registers, modbus::Range::of(0, 1), {}},
      std::vector<std::uint16_t>{42});
  const auto bytes = request.pdu();
  EXPECT_EQ(ask(Pdu(bytes.begin(), bytes.end()))[0], 66) << "the code is asked when it is due";
  EXPECT_THAT(hooks.calls, IsEmpty());
  hooks.refused = {1, 42};
  now = due;
  handler.tick(now);
  ASSERT_EQ(outcomes.told.size(), 1U);
  EXPECT_EQ(outcomes.told[0].kind, modbus::Change::Kind::failed);
  EXPECT_EQ(outcomes.told[0].table, static_cast<std::uint8_t>(modbus::Reason::hardware));
  EXPECT_EQ(ask(pdu(3, {0, 1})), (Pdu{3, 2, 0, 0}));
}

TEST_F(HookedNode, A_refused_value_is_an_exception_but_no_hardware_error) {
  hooks.refused = {1, 7};
  EXPECT_EQ(write(0, {7}), failure);
  EXPECT_EQ(statistics.exceptions_04, 1U);
  EXPECT_EQ(statistics.hardware_errors, 0U);
}

TEST_F(HookedNode, What_was_accepted_before_a_refusal_is_called_again_with_its_old_value) {
  ASSERT_NE(write(0, {1, 2, 3}), failure);
  hooks.calls.clear();
  hooks.refused = {2, 8};
  EXPECT_EQ(write(0, {7, 8, 9}), failure);
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(1U, 7), std::pair(2U, 8), std::pair(1U, 1)));
  EXPECT_EQ(ask(pdu(3, {0, 3})), (Pdu{3, 6, 0, 1, 0, 2, 0, 3}));
}

TEST_F(HookedNode, A_node_that_does_not_show_that_it_is_one_has_nothing_of_nodes) {
  hooks.is_node = false;
  Handler foreign{
      map, Hardware(lines, nullptr, &hooked), {memory.image, statistics, watchdog, links, changes, schedule}};
  foreign.set_machine({});
  const auto answer = [&](const Pdu& request) {
    std::array<std::uint8_t, modbus::max_pdu_size> reply{};
    return Pdu(reply.data(), reply.data() + foreign.handle(request, session, now, reply));
  };
  EXPECT_EQ(answer(pdu(4, {0xFF00, 2})), (Pdu{0x84, 2}));
  for (const Pdu& request : {Pdu{20, 0}, Pdu{43, 0}, Pdu{65, 0}, Pdu{66, 0}})
    EXPECT_EQ(answer(request), (Pdu{static_cast<std::uint8_t>(request[0] | 0x80U), 1}));
  EXPECT_EQ(answer(pdu(4, {0, 1})), (Pdu{4, 2, 0, 0}));
}

TEST_F(HookedNode, Each_for_itself_only_what_is_new_is_asked_about_and_what_is_refused_stays) {
  ASSERT_NE(write(0, {1, 2, 3, 3}), failure);
  hooks.calls.clear();
  hooks.refused = {2, 8};
  std::vector<std::uint16_t> next{7, 8, 9, 2};
  EXPECT_FALSE(hooked.write_each(Table::holding_registers, modbus::Range::of(0, 4), next));
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(1U, 7), std::pair(2U, 8), std::pair(3U, 2)));
  EXPECT_THAT(next, ElementsAre(7, 2, 3, 2));
  hooks.calls.clear();
  next = {1, 2, 3, 3};
  EXPECT_TRUE(hooked.write_each(Table::holding_registers, modbus::Range::of(0, 4), next));
  EXPECT_THAT(hooks.calls, IsEmpty()) << "these are in force";
}

TEST_F(HookedNode, A_point_that_is_written_in_part_is_asked_about_as_a_whole) {
  ASSERT_NE(write(1, {5, 6}), failure);
  hooks.calls.clear();
  EXPECT_NE(write(2, {9}), failure);
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(2U, 5)));
  EXPECT_EQ(ask(pdu(3, {1, 2})), (Pdu{3, 4, 0, 5, 0, 9}));
}

TEST_F(HookedNode, Of_a_shared_register_only_the_points_that_change_are_asked_about) {
  EXPECT_NE(write(3, {2}), failure);
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(4U, 2)));
  hooks.calls.clear();
  EXPECT_NE(write(3, {2}), failure);
  EXPECT_THAT(hooks.calls, IsEmpty());
}

TEST_F(HookedNode, When_a_line_cannot_be_driven_the_code_gets_its_old_values_again) {
  lines.broken = true;
  const MapPtr lamps = fakes::MapBuilder().add(Table::coils, "lamp", 0, Type::BOOL).build();
  OwnedImage image(lamps->map());
  HookedPoints points(lamps->map(), image.image, hooks);
  Hardware hardware(lines, nullptr, &points);
  const std::uint16_t on = 1;
  const auto driven = hardware.drive(Table::coils, modbus::Range::of(0, 1), {&on, 1});
  ASSERT_FALSE(driven);
  EXPECT_TRUE(driven.error().hardware_failed);
  EXPECT_THAT(hooks.calls, ElementsAre(std::pair(0U, 1), std::pair(0U, 0)));
}

TEST_F(HookedNode, What_the_code_sets_is_read_from_the_next_request_on) {
  EXPECT_EQ(ask(pdu(4, {0, 1})), (Pdu{4, 2, 0, 0}));
  hooks.set = 0x1234;
  EXPECT_EQ(ask(pdu(4, {0, 1})), (Pdu{4, 2, 0x12, 0x34}));
}

TEST_F(HookedNode, The_code_may_refuse_what_is_read_with_an_exception_of_its_own) {
  hooks.unreadable = 2;
  EXPECT_EQ(ask(pdu(3, {0, 4})), (Pdu{0x83, 6}));
  EXPECT_EQ(ask(pdu(3, {0, 2})), (Pdu{3, 4, 0, 0, 0, 0}));
  EXPECT_EQ(ask(pdu(3, {3, 1})), (Pdu{3, 2, 0, 0}));
  EXPECT_EQ(ask(pdu(3, {0, 100})), (Pdu{0x83, 2})) << "what nobody has is no question";
  EXPECT_EQ(statistics.hardware_errors, 0U);
}

TEST_F(HookedNode, A_read_that_the_code_refuses_writes_nothing_in_the_same_request) {
  hooks.unreadable = 2;
  EXPECT_EQ(ask(pdu(23, {2, 1, 0, 1}, {2, 0, 7})), (Pdu{0x97, 6}));
  EXPECT_THAT(hooks.calls, IsEmpty());
  EXPECT_EQ(ask(pdu(23, {0, 1, 2, 1}, {2, 0, 7})), (Pdu{23, 2, 0, 0}))
      << "what is written may be another register";
}

TEST_F(HookedNode, The_code_answers_unless_it_says_otherwise) {
  EXPECT_TRUE(Hardware(lines, nullptr, &hooked).answers());
  EXPECT_TRUE(Hardware(lines).answers()) << "where no code is";
}

TEST_F(HookedNode, The_code_is_told_to_make_its_outputs_safe) {
  (void)Hardware(lines, nullptr, &hooked).drive_safe();
  EXPECT_EQ(hooks.safe, 1);
}

}  // namespace
}  // namespace coupler::device
