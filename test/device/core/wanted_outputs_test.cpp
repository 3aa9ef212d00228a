// SPDX-License-Identifier: Apache-2.0
// What a firmware wants of outputs with a line, and what it hears of lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>
#include <utility>
#include <vector>

#include "coupler/device/core/hooks.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Logic : Hooks {
  void put_new_values(Image&, Changes&) override {}
  bool accept(std::uint32_t point, const std::uint16_t* level) override {
    asked.emplace_back(point, level[0] != 0);
    return accepts;
  }
  Span<const WantedOutput> take_wanted_outputs() override {
    taken = std::exchange(wanted, {});
    return taken;
  }
  void not_driven(const WantedOutput& which, bool watchdog) override {
    failed.emplace_back(which.point, which.level, watchdog);
  }
  bool take_level(std::uint32_t point, bool level, bool is_news) override {
    heard.emplace_back(point, level, is_news);
    return !fails;
  }

  bool accepts = true;
  bool fails = false;
  std::vector<WantedOutput> wanted;
  std::vector<WantedOutput> taken;
  std::vector<std::pair<std::uint32_t, bool>> asked;
  std::vector<std::tuple<std::uint32_t, bool, bool>> failed;
  std::vector<std::tuple<std::uint32_t, bool, bool>> heard;
};

void with_line(Point& point) { point.line.name = "GPIO17"; }

// Points: coils 0 motor (safe off), 1 fan (safe hold), 2 plain, without a line; input 3 door.
struct BoardLogic : testing::Test {
  BoardLogic() { lines.outputs = {{0, {}}, {1, {}}}; }
  static MapPtr made() {
    Watchdog guard;
    guard.timeout = std::chrono::milliseconds(500);
    return fakes::MapBuilder()
        .add(Table::coils, "motor", 0, codec::Type::BOOL, with_line)
        .add(Table::coils, "fan", 1, codec::Type::BOOL,
             [](Point& point) {
               with_line(point);
               point.safe = Safe::hold;
             })
        .coil("plain", 2)
        .add(Table::discrete_inputs, "door", 0, codec::Type::BOOL, with_line)
        .watchdog(guard)
        .build();
  }
  std::uint16_t coil(std::uint32_t address) const {
    return memory.image.find(Table::coils, modbus::Range::of(address, 1))[0];
  }
  std::uint8_t write(int address, bool on) {
    std::array<std::uint8_t, modbus::max_pdu_size> reply{};
    const Pdu request = pdu(5, {address, on ? 0xFF00 : 0});
    (void)handler.handle(request, session, now, reply);
    return reply[0];
  }
  void want(std::uint32_t point, bool level) {
    logic.wanted = {{point, level}};
    handler.tick(now);
  }
  bool tell() { return hooked.tell_levels(changes.ring()); }

  MapPtr owner = made();
  const Map& map = owner->map();
  OwnedImage memory{map};
  FakeLines lines;
  Logic logic;
  HookedPoints hooked{map, memory.image, logic};
  ClientSession session;
  Statistics statistics;
  TimePoint now{};
  OutputWatchdog watchdog{map.service.watchdog};
  std::vector<EdgePoints::Link> links;
  std::vector<ChangeRing::Entry> ring = std::vector<ChangeRing::Entry>(4);
  std::vector<std::uint16_t> told = std::vector<std::uint16_t>(memory.image.bits().size());
  Changes changes{memory.image, ring, told};
  std::vector<ScheduledOutput> scheduled = std::vector<ScheduledOutput>(2);
  OutputSchedule schedule{scheduled, &changes};
  Handler handler{
      map, Hardware(lines, nullptr, &hooked), {memory.image, statistics, watchdog, links, changes, schedule}};
};

TEST_F(BoardLogic, What_the_firmware_wants_is_driven_and_told_and_its_code_is_not_asked) {
  handler.tell_changes(7, now);
  logic.accepts = false;
  want(0, true);
  EXPECT_EQ(coil(0), 1);
  EXPECT_EQ(changes.ring().newest(), 1U);
  EXPECT_THAT(logic.asked, IsEmpty());
  EXPECT_THAT(logic.failed, IsEmpty());
}

TEST_F(BoardLogic, It_neither_arms_nor_feeds_the_watchdog) {
  want(0, true);
  EXPECT_EQ(watchdog.state(), OutputWatchdog::State::idle);
  ASSERT_EQ(write(0, true), 5);
  const auto due = watchdog.deadline();
  ASSERT_TRUE(due.has_value());
  now += std::chrono::milliseconds(100);
  want(0, false);
  EXPECT_EQ(watchdog.deadline(), due);
}

TEST_F(BoardLogic, What_the_watchdog_made_safe_stays_so_until_a_client_writes) {
  ASSERT_EQ(write(0, true), 5);
  now += std::chrono::seconds(1);
  handler.tick(now);
  ASSERT_EQ(watchdog.state(), OutputWatchdog::State::expired);
  const std::uint16_t before = coil(0);
  want(0, true);
  EXPECT_THAT(logic.failed, ElementsAre(std::tuple(0U, true, true)));
  EXPECT_EQ(coil(0), before);
  want(1, true);  // its safe state is no level
  EXPECT_EQ(logic.failed.size(), 1U);
  ASSERT_EQ(write(0, false), 5);
  want(0, true);
  EXPECT_EQ(logic.failed.size(), 1U);
  EXPECT_EQ(coil(0), 1);
}

TEST_F(BoardLogic, A_line_that_fails_is_told_and_changes_nothing) {
  lines.broken = true;
  want(0, true);
  EXPECT_THAT(logic.failed, ElementsAre(std::tuple(0U, true, false)));
  EXPECT_EQ(coil(0), 0);
}

TEST_F(BoardLogic, The_code_is_asked_before_a_line_is_driven_for_a_client) {
  logic.accepts = false;
  EXPECT_EQ(write(0, true), 0x85);
  EXPECT_THAT(logic.asked, ElementsAre(std::pair(0U, true)));
  EXPECT_EQ(coil(0), 0);
}

TEST_F(BoardLogic, Levels_at_the_start_are_no_news_and_each_change_of_a_line_is_heard) {
  handler.tell_changes(7, now);
  hooked.begin_levels(changes.ring());
  EXPECT_THAT(logic.heard, ElementsAre(std::tuple(0U, false, false), std::tuple(1U, false, false),
                                       std::tuple(3U, false, false)));
  logic.heard.clear();
  changes.set_level(0, true, now);
  changes.set_level(0, false, now);
  ASSERT_EQ(write(2, true), 5);  // no line
  EXPECT_TRUE(tell());
  EXPECT_THAT(logic.heard, ElementsAre(std::tuple(3U, true, true), std::tuple(3U, false, true)));
  EXPECT_TRUE(tell());
  EXPECT_EQ(logic.heard.size(), 2U);
}

TEST_F(BoardLogic, Where_changes_were_lost_the_levels_are_heard) {
  handler.tell_changes(7, now);
  hooked.begin_levels(changes.ring());
  logic.heard.clear();
  changes.set_level(0, true, now);
  changes.lose(3);
  EXPECT_TRUE(tell());
  EXPECT_THAT(logic.heard, ElementsAre(std::tuple(3U, true, true), std::tuple(0U, false, true),
                                       std::tuple(1U, false, true), std::tuple(3U, true, true)));
}

TEST_F(BoardLogic, Code_that_fails_at_a_change_is_told) {
  handler.tell_changes(7, now);
  hooked.begin_levels(changes.ring());
  changes.set_level(0, true, now);
  logic.fails = true;
  EXPECT_FALSE(tell());
}

}  // namespace
}  // namespace coupler::device
