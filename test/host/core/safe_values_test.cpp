// SPDX-License-Identifier: Apache-2.0
// Safe values while the driver goes on: Device::make_safe().
#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using Outcome = WriteResult::Outcome;

struct SafeValuesTest : test::DeviceTest {
  /// Whatever `on_shutdown` says: it says hold.
  void start_online(OnReconnect on_reconnect = OnReconnect::drop) {
    fakes::MapBuilder builder;
    const auto half = builder.keep({500});
    builder.add(Table::coils, "lamp", 0, Type::BOOL);
    builder.add(Table::coils, "brake", 1, Type::BOOL, [](Point& point) { point.safe = Safe::on; });
    builder.add(Table::coils, "hold", 2, Type::BOOL, [](Point& point) { point.safe = Safe::hold; });
    builder.add(Table::holding_registers, "valve", 0, Type::UINT, [&](Point& point) {
      point.safe = Safe::on;
      point.safe_value = half;
    });
    builder.head().on_reconnect = on_reconnect;
    start(builder, Verify::off);
    device.values[{Table::coils, 0}] = 1;
    run_for(milliseconds(50));
    device.requests.clear();
  }
  static bool is_ready(std::future<CallAnswer>& asked) {
    return asked.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
};

TEST_F(SafeValuesTest, They_go_before_all_that_waits_and_supersede_what_would_undo_them) {
  start_online();
  push("valve", 9);
  push("hold", 1);
  push("lamp", 1);
  auto asked = engine->make_safe();
  engine->step();
  ASSERT_TRUE(is_ready(asked));
  const auto answer = asked.get();
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.text, "3 of 3 outputs have their safe values");
  EXPECT_EQ(engine->statistics().written(Outcome::superseded), 2U);
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write coils 0+2", "write register 0", "write coil 2"));
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 500);
}

TEST_F(SafeValuesTest, They_go_before_what_was_to_be_sent_next) {
  start_online();
  clock.advance(milliseconds(100));
  push("lamp", 1);
  ASSERT_TRUE(shared->turns.try_take(this));
  EXPECT_FALSE(engine->send_now());
  shared->turns.release();
  auto asked = engine->make_safe();
  engine->step();
  EXPECT_TRUE(is_ready(asked));
  EXPECT_EQ(device.requests.front(), "write coils 0+2");
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
}

TEST_F(SafeValuesTest, They_go_before_what_waits_for_its_units_turn) {
  start_online();
  push("lamp", 1);
  std::future<CallAnswer> asked;
  during_wait_for_turn([this] { engine->step(); }, [&] { asked = engine->make_safe(); });
  ASSERT_TRUE(asked.valid() && is_ready(asked));
  EXPECT_TRUE(asked.get().success);
  EXPECT_THAT(device.requests, ElementsAre("write coils 0+2", "write register 0"));
  EXPECT_EQ(engine->statistics().written(Outcome::superseded), 1U);
}

TEST_F(SafeValuesTest, A_call_that_comes_meanwhile_supersedes_what_was_queued_before_it) {
  start_online();
  std::future<CallAnswer> second;
  device.refuses = [&](const std::string& request) {
    if (request == "write register 0" && !second.valid()) {
      push("lamp", 1);
      second = engine->make_safe();
    }
    return std::optional<modbus::Exception>();
  };
  auto first = engine->make_safe();
  engine->step();
  EXPECT_TRUE(is_ready(first));
  run_for(milliseconds(50));
  ASSERT_TRUE(is_ready(second));
  EXPECT_TRUE(second.get().success);
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ(engine->statistics().written(Outcome::superseded), 1U);
}

TEST_F(SafeValuesTest, Without_any_no_turn_is_kept) {
  fakes::MapBuilder builder;
  builder.add(Table::coils, "hold", 2, Type::BOOL, [](Point& point) { point.safe = Safe::hold; });
  start(builder, Verify::off);
  run_for(milliseconds(50));
  engine->make_safe();
  engine->step();
  EXPECT_TRUE(is_turn_free());
}

TEST_F(SafeValuesTest, What_waits_for_an_output_of_a_tool_is_superseded_though_that_has_no_safe_value) {
  static constexpr Tool clamp = [] {
    Tool tool;
    tool.close = "hold";
    return tool;
  }();
  fakes::MapBuilder builder;
  builder.add(Table::coils, "hold", 2, Type::BOOL, [](Point& point) { point.safe = Safe::hold; });
  builder.head().tools = {&clamp, 1};
  start(builder, Verify::off);
  run_for(milliseconds(50));
  push("hold", 1);
  engine->make_safe();
  run_for(milliseconds(50));
  EXPECT_EQ(engine->statistics().written(Outcome::superseded), 1U);
  EXPECT_EQ((device.values[{Table::coils, 2}]), 0);
}

TEST_F(SafeValuesTest, Of_the_outputs_of_a_tool_those_that_go_off_are_written_first) {
  static constexpr Tool clamp = [] {
    Tool tool;
    tool.close = "close";
    tool.open = "open";
    return tool;
  }();
  fakes::MapBuilder builder;
  builder.add(Table::coils, "close", 0, Type::BOOL, [](Point& point) { point.safe = Safe::on; });
  builder.coil("lamp", 1).coil("open", 20);
  builder.head().tools = {&clamp, 1};
  const MapPtr map = builder.build();
  const std::vector<Write> values = safe_values(map->map());
  ASSERT_EQ(values.size(), 3U);
  EXPECT_EQ(map->map().points[values[0].point].name, "open");
  EXPECT_EQ(map->map().points[values[1].point].name, "close");
}

TEST_F(SafeValuesTest, The_next_message_drives_again) {
  start_online();
  engine->make_safe();
  engine->step();
  push("lamp", 1);
  engine->step();
  EXPECT_EQ((device.values[{Table::coils, 0}]), 1);
}

TEST_F(SafeValuesTest, An_output_that_refuses_is_named_and_the_others_have_theirs) {
  start_online();
  device.missing.insert({Table::coils, 0});
  auto asked = engine->make_safe();
  engine->step();
  const auto answer = asked.get();
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, HasSubstr("2 of 3 outputs have their safe values; lamp: exception 02"));
  EXPECT_EQ((device.values[{Table::coils, 1}]), 1);
}

TEST_F(SafeValuesTest, A_link_that_breaks_meanwhile_is_told) {
  start_online();
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  auto asked = engine->make_safe();
  engine->step();
  const auto answer = asked.get();
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, HasSubstr("not all outputs have their safe values: no reply"));
}

TEST_F(SafeValuesTest, Offline_it_fails_at_once) {
  device.refuse_connect = NotConnected{"no route"};
  start_online();
  auto asked = engine->make_safe();
  ASSERT_TRUE(is_ready(asked));
  EXPECT_FALSE(asked.get().success);
}

TEST_F(SafeValuesTest, A_reconnect_restores_them_and_not_what_was_before) {
  start_online(OnReconnect::restore);
  push("lamp", 1);
  engine->step();
  engine->make_safe();
  engine->step();
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(99));
  device.values.clear();
  run_for(milliseconds(300));
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ((device.values[{Table::coils, 1}]), 1);
}

}  // namespace
}  // namespace coupler::host
