// SPDX-License-Identifier: Apache-2.0
// `priority: high`: which writes go before which, and before which requests they do not go.
#include <gmock/gmock.h>

#include <utility>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using testing::ElementsAre;
using Outcome = WriteResult::Outcome;

struct PriorityTest : test::DeviceTest {
  static void high(Point& point) { point.host.priority = HostOptions::Priority::high; }
  void start_online() {
    start(builder, Verify::off);
    run_for(milliseconds(50));
    device.requests.clear();
  }
  void SetUp() override {
    builder.coil("lamp", 5);
    builder.add(Table::coils, "stop", 50, Type::BOOL, high);
    builder.holding("speed", 5);
    builder.add(Table::holding_registers, "brake", 50, Type::UINT, high);
  }
  void step(int times) {
    for (int i = 0; i < times; ++i) engine->step();
  }
  fakes::MapBuilder builder;
};

TEST_F(PriorityTest, Its_writes_go_before_all_others_that_wait) {
  start_online();
  for (const char* point : {"lamp", "speed", "brake", "stop"}) push(point, 1);
  step(4);
  EXPECT_THAT(device.requests,
              ElementsAre("write register 50", "write coil 50", "write coil 5", "write register 5"));
}

TEST_F(PriorityTest, They_go_before_one_that_was_to_be_sent_next) {
  start_online();
  ASSERT_TRUE(shared->turns.try_take(this));
  push("lamp", 1);
  EXPECT_FALSE(engine->send_now());
  shared->turns.release();
  push("stop", 1);
  step(2);
  EXPECT_THAT(device.requests, ElementsAre("write coil 50", "write coil 5"));
  EXPECT_EQ(engine->statistics().written(Outcome::ok), 2U);
}

TEST_F(PriorityTest, They_go_before_one_that_waits_for_its_units_turn) {
  start_online();
  push("lamp", 1);
  during_wait_for_turn([this] { step(2); }, [this] { push("stop", 1); });
  EXPECT_THAT(device.requests, ElementsAre("write coil 50", "write coil 5"));
}

TEST_F(PriorityTest, A_deadman_that_expires_meanwhile_goes_with_them) {
  const auto zero = builder.keep({0});
  builder.add(Table::coils, "crane", 200, Type::BOOL, [&](Point& point) {
    point.host.deadman = {milliseconds(60), zero};
    high(point);
  });
  start_online();
  push("crane", 1);
  step(1);
  device.requests.clear();
  push("lamp", 1);
  during_wait_for_turn([this] { step(1); }, [this] { clock.advance(milliseconds(100)); });
  EXPECT_THAT(device.requests, ElementsAre("write coil 200"));
}

TEST_F(PriorityTest, A_read_that_is_overdue_by_a_period_still_gets_every_second_transaction) {
  start_online();
  clock.advance(milliseconds(200));
  for (std::uint16_t i = 0; i < 4; ++i) {
    push("brake", i);
    engine->step();
  }
  EXPECT_THAT(device.requests,
              ElementsAre("write register 50", "read coils 5+1", "write register 50", "read coils 50+1"));
}

TEST_F(PriorityTest, What_waits_is_written_when_nothing_of_high_priority_waits_any_more) {
  start_online();
  push("lamp", 1);
  for (std::uint16_t i = 0; i < 3; ++i) {
    push("stop", i % 2U);
    engine->step();
  }
  EXPECT_EQ(device.count("write coil 5"), 0U);
  engine->step();
  EXPECT_EQ(device.requests.back(), "write coil 5");
}

TEST_F(PriorityTest, A_deadman_value_goes_with_the_writes_of_its_point) {
  const auto zero = builder.keep({0});
  const auto deadman = [&](Point& point) { point.host.deadman = {milliseconds(60), zero}; };
  builder.add(Table::coils, "winch", 100, Type::BOOL, deadman);
  builder.add(Table::coils, "crane", 200, Type::BOOL, [&](Point& point) {
    deadman(point);
    high(point);
  });
  builder.head().polling.rate = 1;  // no read comes between
  start_online();
  push("winch", 1);
  push("crane", 1);
  step(2);
  device.requests.clear();
  clock.advance(milliseconds(100));
  push("lamp", 1);
  engine->step();
  EXPECT_EQ(device.requests.front(), "write coil 200");
  step(2);
  EXPECT_THAT(device.requests, ElementsAre("write coil 200", "write coil 5", "write coil 100"));
}

TEST_F(PriorityTest, Safe_values_go_before_it) {
  start_online();
  push("brake", 7);
  auto asked = engine->make_safe();
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write coil 5", "write coil 50"));
}

TEST_F(PriorityTest, Writes_that_were_rejected_in_one_request_keep_their_priority_one_by_one) {
  builder.add(Table::holding_registers, "clamp", 51, Type::UINT, high);
  start_online();
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request != "write registers 50+2") return std::nullopt;
    return modbus::Exception::illegal_data_address;
  };
  for (const char* point : {"lamp", "brake", "clamp"}) push(point, 1);
  step(4);
  EXPECT_THAT(device.requests,
              ElementsAre("write registers 50+2", "write register 50", "write register 51", "write coil 5"));
}

}  // namespace
}  // namespace coupler::host
