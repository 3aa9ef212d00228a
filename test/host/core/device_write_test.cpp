// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <utility>

#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using test::DeviceTest;
using testing::ElementsAre;

struct DeviceWriteTest : DeviceTest {
  void start_online(const MapBuilder& builder) {
    start(builder);
    run_for(milliseconds(50));
    device.requests.clear();
  }
};

TEST_F(DeviceWriteTest, A_write_goes_out_although_no_read_is_due) {
  start_online(MapBuilder().holding("a", 5));
  push("a", 7);
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write register 5"));
  EXPECT_EQ((device.values[{Table::holding_registers, 5}]), 7);
}

TEST_F(DeviceWriteTest, Writes_go_before_the_reads_that_are_due_and_keep_their_order) {
  start_online(MapBuilder().coil("a", 5).coil("b", 50));
  clock.advance(milliseconds(100));
  engine->step();
  push("b", 1);
  push("a", 2);
  for (int i = 0; i < 3; ++i) engine->step();
  EXPECT_THAT(device.requests,
              ElementsAre("read coils 5+1", "write coil 50", "write coil 5", "read coils 50+1"));
}

TEST_F(DeviceWriteTest, A_read_that_is_overdue_by_a_period_gets_every_second_transaction) {
  start_online(MapBuilder().holding("a", 5).holding("b", 50));
  clock.advance(milliseconds(200));
  for (std::uint16_t i = 0; i < 5; ++i) {
    push("a", i);
    engine->step();
  }
  EXPECT_THAT(device.requests,
              ElementsAre("write register 5", "read holding_registers 5+1", "write register 5",
                          "read holding_registers 50+1", "write register 5"));
}

TEST_F(DeviceWriteTest, What_can_be_sent_at_once_waits_for_an_overdue_read_too) {
  start_online(MapBuilder().holding("a", 5));
  push("a", 1);
  engine->step();
  push("a", 2);
  clock.advance(milliseconds(200));
  EXPECT_FALSE(engine->send_now());
  engine->step();
  EXPECT_TRUE(engine->send_now());
  EXPECT_EQ(device.requests.back(), "read holding_registers 5+1");
}

TEST_F(DeviceWriteTest, A_point_that_is_written_without_end_is_shown_after_each_write_that_was_acknowledged) {
  start_online(MapBuilder().holding("a", 5));
  sink->values.clear();
  device.during_read = [this] { push("a", 99); };  // one always waits
  for (std::uint16_t i = 1; i <= 3; ++i) {
    push("a", i);
    engine->step();
    clock.advance(milliseconds(200));
    engine->step();
  }
  EXPECT_THAT(sink->values["a"], ElementsAre(1, 2, 3));
}

TEST_F(DeviceWriteTest, A_write_that_comes_while_a_read_waits_for_its_turn_goes_first) {
  start_online(MapBuilder().holding("a", 5));
  clock.advance(milliseconds(200));
  during_wait_for_turn([this] { engine->step(); },
                       [this] {
                         push("a", 7);
                         link->wake();
                       });
  for (int i = 0; i < 2; ++i) engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write register 5", "read holding_registers 5+1"));
}

TEST_F(DeviceWriteTest, A_refused_write_is_reported_and_keeps_the_connection) {
  start_online(MapBuilder().coil("a", 5));
  device.next_errors.push_back(ExceptionReply{modbus::Exception::server_device_failure});
  push("a", 1);
  run_for(milliseconds(200));
  EXPECT_EQ(sink->reported("write to a: exception 04 (server device failure)"), 1);
  EXPECT_EQ(device.count("connect"), 0U);
}

TEST_F(DeviceWriteTest, Writes_that_are_pushed_together_are_one_request) {
  start_online(MapBuilder().holding("a", 5).holding("b", 6));
  std::array<Write, 2> both;
  both[1].point = 1;
  for (Write& write : both) write.ordered = true;
  engine->push_together(both);
  EXPECT_TRUE(engine->send_now());
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write registers 5+2"));
}

TEST_F(DeviceWriteTest, If_one_of_them_is_refused_the_other_is_not_sent_either) {
  start_online(MapBuilder().holding("a", 5).add(Table::holding_registers, "b", 6, codec::Type::REAL));
  std::array<Write, 2> both;
  both[1].point = 1;
  both[1].registers = {0x7FC0, 0x7FC0};  // NaN in each order
  std::array<WriteTicket, 2> tickets;
  for (std::size_t i = 0; i < both.size(); ++i) {
    both[i].ordered = true;
    both[i].listener = &tickets[i];
  }
  engine->push_together(both);
  EXPECT_EQ(tickets[1].wait().outcome, WriteResult::Outcome::refused);
  EXPECT_EQ(tickets[0].wait().text, "dropped: the value of b, which is written together with it, is refused");
  run_for(milliseconds(50));
  EXPECT_EQ(device.count("write register 5"), 0U);
}

TEST_F(DeviceWriteTest, A_write_without_an_answer_is_reported_as_lost_and_not_repeated) {
  start_online(MapBuilder().coil("a", 5));
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  push("a", 1);
  run_for(milliseconds(500));
  EXPECT_EQ(sink->reported("write to a: lost: no reply within 3000 ms"), 1);
  EXPECT_EQ(device.count("write coil 5"), 1U);
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
}

TEST_F(DeviceWriteTest, Writes_while_offline_are_dropped_and_reported_once_with_their_number_later) {
  device.refuse_connect = NotConnected{"refused"};
  start(MapBuilder().coil("a", 5));
  for (int i = 0; i < 3; ++i) {
    push("a", 1);
    run_for(milliseconds(50));
  }
  EXPECT_EQ(sink->reported("write to a: dropped"), 1);
  device.refuse_connect.reset();
  run_for(milliseconds(500));
  EXPECT_EQ(device.count("write coil 5"), 0U);
  EXPECT_EQ(sink->reported("3 writes were dropped"), 1);
}

TEST_F(DeviceWriteTest, A_map_of_outputs_that_cannot_be_read_is_online_by_its_writes) {
  MapBuilder builder;
  builder.command("a", 5);
  start(builder, Verify::off);
  run_for(milliseconds(50));
  EXPECT_TRUE(sink->online.empty());
  push("a", 1);
  engine->step();
  EXPECT_EQ((device.values[{Table::coils, 5}]), 1);
  EXPECT_THAT(sink->online, ElementsAre(true));
}

}  // namespace
}  // namespace coupler::host
