// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/tools.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/motion/sample_tools.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

constexpr Tool tools_of_map[] = {clamp(), cup()};

MapPtr map_with_tools() {
  fakes::MapBuilder builder;
  builder.coil("valve_close", 0).coil("valve_open", 1).input("sensor_closed", 0).input("sensor_open", 1);
  builder.holding("vacuum", 0, [] {
    codec::Format bit;
    bit.type = codec::Type::BOOL;
    bit.bit = 3;
    return bit;
  }());
  builder.head().tools = tools_of_map;
  return builder.build();
}

/// Results of writes come when acknowledge() is called.
struct ToolsTest : SampleDevice {
  ToolsTest() : SampleDevice(map_with_tools()) { tools.on_online(true, now()); }

  void read(std::string_view name, bool on) { read_for(tools, name, on ? 1 : 0); }
  void begin(std::size_t tool, ToolEnd end) {
    tools.begin(tool, end, now(), [this](const ToolResult& result) { results.push_back(result.text); });
  }
  /// Carries out what has been written.
  void acknowledge() {
    while (!writes.empty()) {
      const Write write = writes.front();
      writes.erase(writes.begin());
      write.listener->on_result({WriteResult::Outcome::ok});
      tools.step(now());
    }
  }

  std::vector<Write> writes;
  std::vector<std::string> asked;
  std::vector<std::pair<std::size_t, ToolState>> shown;
  std::vector<std::string> results;
  int woken = 0;
  Tools tools{
      map->map(),
      values,
      now(),
      {[this](const Write& write) { writes.push_back(write); },
       [this](std::uint32_t point) { asked.emplace_back(map->map().points[point].name); },
       [this] { ++woken; },
       [this](std::size_t tool, const ToolStatus& status) { shown.emplace_back(tool, status.state); }}};
};

TEST_F(ToolsTest, A_goal_writes_its_outputs_and_asks_for_its_inputs) {
  begin(0, ToolEnd::closed);
  EXPECT_GT(woken, 0);
  tools.step(now());
  ASSERT_EQ(writes.size(), 1U);
  EXPECT_EQ(writes[0].point, index("valve_open"));
  EXPECT_FALSE(writes[0].bit(0));
  EXPECT_TRUE(writes[0].ordered);
  acknowledge();
  EXPECT_THAT(asked, ElementsAre("sensor_closed", "sensor_open"));
  read("sensor_open", false);
  read("sensor_closed", true);
  tools.step(now());
  EXPECT_THAT(results, ElementsAre(StartsWith("closed after ")));
}

TEST_F(ToolsTest, An_output_may_be_a_bit_of_a_register) {
  begin(1, ToolEnd::closed);
  tools.step(now());
  ASSERT_EQ(writes.size(), 1U);
  EXPECT_EQ(writes[0].point, index("vacuum"));
  EXPECT_EQ(writes[0].registers[0], 1U << 3U);
}

TEST_F(ToolsTest, The_result_of_a_write_may_come_while_it_is_made) {
  Tools at_once(map->map(), values, now(),
                {[](const Write& write) { write.listener->on_result({WriteResult::Outcome::ok}); },
                 [](std::uint32_t) {}, [] {}, [](std::size_t, const ToolStatus&) {}});
  at_once.on_online(true, now());
  std::vector<std::string> said;
  at_once.begin(1, ToolEnd::closed, now(), [&](const ToolResult& result) { said.push_back(result.text); });
  const Time next = at_once.step(now());
  at_once.step(at_once.step(now()));
  at_once.step(now() + milliseconds(20));
  EXPECT_EQ(next, Time::max()) << "it is woken";
  EXPECT_THAT(said, ElementsAre(testing::EndsWith(" ms, its travel time")));
}

TEST_F(ToolsTest, A_write_that_fails_says_why) {
  begin(1, ToolEnd::closed);
  tools.step(now());
  writes[0].listener->on_result({WriteResult::Outcome::lost, std::nullopt, "no reply"});
  tools.step(now());
  EXPECT_THAT(results, ElementsAre("vacuum could not be switched on: lost: no reply"));
}

TEST_F(ToolsTest, Each_goal_has_its_own_result) {
  begin(0, ToolEnd::closed);
  begin(0, ToolEnd::open);
  begin(1, ToolEnd::open);
  tools.step(now());
  EXPECT_THAT(results, ElementsAre(StartsWith("replaced by a newer goal")));
  tools.disturb_all("safe values were requested", now());
  tools.step(now());
  EXPECT_EQ(results.size(), 3U);
}

TEST_F(ToolsTest, A_device_that_goes_offline_ends_all) {
  begin(0, ToolEnd::closed);
  tools.on_online(false, now());
  tools.step(now());
  EXPECT_THAT(results, ElementsAre(StartsWith("the connection to the device was lost")));
  EXPECT_THAT(writes, IsEmpty());
}

TEST_F(ToolsTest, A_write_by_somebody_else_ends_the_goal_of_that_tool) {
  begin(0, ToolEnd::closed);
  begin(1, ToolEnd::closed);
  tools.disturb(index("valve_open"), "valve_open was written directly", now());
  tools.step(now());
  EXPECT_THAT(results, ElementsAre("valve_open was written directly"));
  ASSERT_EQ(writes.size(), 1U);
  EXPECT_EQ(writes[0].point, index("vacuum"));
}

TEST_F(ToolsTest, A_write_of_an_input_ends_nothing) {
  begin(0, ToolEnd::closed);
  tools.disturb(index("sensor_closed"), "sensor_closed was written directly", now());
  tools.step(now());
  EXPECT_THAT(results, IsEmpty());
}

TEST_F(ToolsTest, After_the_end_a_goal_is_aborted) {
  tools.end("the driver ends", now());
  begin(0, ToolEnd::closed);
  tools.step(now());
  EXPECT_THAT(results, ElementsAre("the driver ends"));
  EXPECT_THAT(writes, IsEmpty());
}

TEST_F(ToolsTest, Only_a_goal_that_runs_is_cancelled_and_only_by_its_sender) {
  const auto send = [this](GoalKey key) {
    tools.begin(
        1, ToolEnd::closed, now(), [this](const ToolResult& result) { results.push_back(result.text); }, key);
  };
  const int one = 1;
  const int other = 2;
  send({&one, 7});
  send({&one, 8});
  tools.cancel(1, {&one, 7}, now());
  tools.cancel(1, {&other, 8}, now());
  tools.step(now());
  EXPECT_THAT(results, ElementsAre(StartsWith("replaced by a newer goal")));
  results.clear();
  acknowledge();
  tools.cancel(1, {&one, 8}, now());
  tools.step(now());
  EXPECT_THAT(results, ElementsAre(StartsWith("cancelled after")));
  tools.cancel(1, {&one, 8}, now());
  tools.step(now());
  EXPECT_EQ(results.size(), 1U);
}

TEST_F(ToolsTest, A_position_is_known_as_long_as_all_of_its_inputs_are) {
  EXPECT_FALSE(tools.position(0, now()));
  read("sensor_closed", false);
  EXPECT_FALSE(tools.position(0, now()));
  const Time before = now();
  read("sensor_open", true);
  const auto first = tools.position(0, now());
  ASSERT_TRUE(first);
  EXPECT_EQ(first->position, 1);
  EXPECT_LE(first->at, before) << "the other input was read before";
  read("sensor_closed", false);
  EXPECT_GE(tools.position(0, now())->at, before);
  EXPECT_FALSE(tools.position(0, now() + std::chrono::hours(1))) << "nothing new has come";
  tools.on_gap(now());
  EXPECT_FALSE(tools.position(0, now()));
}

TEST_F(ToolsTest, A_position_has_no_newer_stamp_than_the_value_that_it_comes_from) {
  read("sensor_closed", false);
  read("sensor_open", true);
  const Time before = now();
  const std::uint16_t off = 0;
  values.store({Table::discrete_inputs, modbus::Range::of(1, 1), {index("sensor_open")}}, {&off, 1},
               {now(), {}}, now());
  read("sensor_closed", false);
  const auto known = tools.position(0, now());  // of the new value nobody has told the tools yet
  ASSERT_TRUE(known);
  EXPECT_EQ(known->position, 1);
  EXPECT_LE(known->at, before);
}

TEST_F(ToolsTest, A_tool_without_inputs_is_in_the_middle_until_it_has_moved) {
  EXPECT_EQ(tools.position(1, now())->position, 0.5);
  begin(1, ToolEnd::closed);
  tools.step(now());
  acknowledge();
  tools.step(now() + milliseconds(301));
  EXPECT_EQ(results.size(), 1U);
  EXPECT_EQ(tools.position(1, now())->position, 0);
  tools.on_online(false, now());
  EXPECT_FALSE(tools.position(1, now()));
}

TEST_F(ToolsTest, A_state_is_shown_at_first_and_when_it_has_changed) {
  tools.step(now());
  EXPECT_THAT(shown, ElementsAre(std::pair(0U, ToolState::unknown), std::pair(1U, ToolState::unknown)));
  shown.clear();
  read("sensor_closed", true);
  tools.step(now());
  EXPECT_THAT(shown, ElementsAre(std::pair(0U, ToolState::closed)));
}

TEST_F(ToolsTest, A_value_that_says_nothing_new_wakes_nobody) {
  read("sensor_closed", true);
  tools.step(now());
  woken = 0;
  read("sensor_closed", true);
  EXPECT_EQ(woken, 0);
}

}  // namespace
}  // namespace coupler::host
