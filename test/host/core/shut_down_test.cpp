// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using testing::ElementsAre;

struct ShutDownTest : test::DeviceTest {
  void start_online(OnShutdown policy) {
    fakes::MapBuilder builder;
    const auto half = builder.keep({500});
    builder.add(Table::coils, "off", 0, Type::BOOL);
    builder.add(Table::coils, "on", 1, Type::BOOL, [](Point& point) { point.safe = Safe::on; });
    builder.add(Table::coils, "hold", 2, Type::BOOL, [](Point& point) { point.safe = Safe::hold; });
    builder.add(Table::holding_registers, "valve", 0, Type::UINT, [&](Point& point) {
      point.safe = Safe::on;
      point.safe_value = half;
    });
    builder.add(Table::holding_registers, "setting", 1, Type::UINT);
    builder.head().on_shutdown = policy;
    owned = builder.build();
    for (std::uint32_t i = 0; i < 3; ++i) device.values[{Table::coils, i}] = 1;
    device.values[{Table::coils, 1}] = 0;
    make_sink();
    make_engine(Verify::off, nullptr);
    run_for(milliseconds(50));
    device.requests.clear();
  }
};

TEST_F(ShutDownTest, With_hold_outputs_stay_as_they_are) {
  start_online(OnShutdown::hold);
  engine->stop();
  EXPECT_TRUE(device.requests.empty());
}

TEST_F(ShutDownTest, With_safe_outputs_get_their_safe_values_and_others_are_left_alone) {
  start_online(OnShutdown::safe);
  engine->stop();
  EXPECT_THAT(device.requests, ElementsAre("write coils 0+2", "write register 0"));
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ((device.values[{Table::coils, 1}]), 1);
  EXPECT_EQ((device.values[{Table::coils, 2}]), 1);
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 500);
}

TEST_F(ShutDownTest, With_safe_an_array_of_coils_gets_a_value_for_each_or_one_for_all) {
  fakes::MapBuilder builder;
  const auto car = builder.keep({1, 0, 1});
  builder.add(Table::coils, "car", 4, Type::BOOL, [&](Point& point) {
    point.count = 3;
    point.safe = Safe::on;
    point.safe_value = car;
  });
  builder.add(Table::coils, "lamps", 7, Type::BOOL, [](Point& point) {
    point.count = 2;
    point.safe = Safe::on;
  });
  builder.head().on_shutdown = OnShutdown::safe;
  start(builder);
  run_for(milliseconds(50));
  engine->stop();
  const std::vector<std::uint16_t> expected{1, 0, 1, 1, 1};
  for (std::uint32_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ((device.values[{Table::coils, 4 + i}]), expected[i]) << i;
}

TEST_F(ShutDownTest, An_output_that_does_not_take_its_safe_value_is_reported_and_the_others_go_on) {
  device.missing.insert({Table::coils, 0});
  start_online(OnShutdown::safe);
  engine->stop();
  EXPECT_EQ(sink->reported("off could not be set to its safe value: exception 02"), 1);
  EXPECT_EQ((device.values[{Table::coils, 1}]), 1);
}

TEST_F(ShutDownTest, A_unit_that_its_gateway_did_not_reach_once_is_tried_again) {
  start_online(OnShutdown::safe);
  device.next_errors = {ExceptionReply{modbus::Exception::gateway_target_failed_to_respond}};
  EXPECT_TRUE(engine->stop());
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 500);
}

TEST_F(ShutDownTest, A_device_that_is_away_at_the_end_is_told_of) {
  device.refuse_connect = NotConnected{"no route"};
  start_online(OnShutdown::safe);
  engine->stop();
  EXPECT_EQ(sink->reported("no output could be set to its safe value: not connected"), 1);
}

TEST_F(ShutDownTest, No_answer_is_awaited_to_a_write_that_could_not_be_sent) {
  start_online(OnShutdown::safe);
  push("off", 1);
  device.connected = false;  // reset by the device
  EXPECT_FALSE(engine->send_now());
  EXPECT_FALSE(engine->stop());
  EXPECT_TRUE(device.requests.empty());
  EXPECT_EQ(sink->reported("no output could be set to its safe value: not connected"), 1);
}

TEST_F(ShutDownTest, Writes_that_still_wait_are_dropped_before_the_safe_values) {
  start_online(OnShutdown::safe);
  push("off", 1);
  engine->stop();
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ(engine->statistics().written(WriteResult::Outcome::dropped), 1U);
}

}  // namespace
}  // namespace coupler::host
