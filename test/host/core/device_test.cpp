// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device.hpp"

#include <gmock/gmock.h>

#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using test::DeviceTest;
using testing::ElementsAre;

TEST_F(DeviceTest, A_point_is_read_at_once_and_then_at_its_rate) {
  device.values[{Table::holding_registers, 5}] = 42;
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(250));
  EXPECT_THAT(sink->values["a"], ElementsAre(42, 42, 42));
}

TEST_F(DeviceTest, Slow_replies_make_cycles_fewer_not_late) {
  start(MapBuilder().holding("a", 5));
  device.reply_time = milliseconds(130);
  run_for(milliseconds(1000));
  EXPECT_EQ(sink->values["a"].size(), 5U);
  EXPECT_GE(engine->statistics().overruns, 4U);
}

TEST_F(DeviceTest, It_is_online_once_it_answers) {
  start(MapBuilder().holding("a", 5));
  EXPECT_TRUE(sink->online.empty());
  run_for(milliseconds(1));
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(DeviceTest, Without_an_identity_check_it_is_online_after_the_first_reply) {
  start(MapBuilder().holding("a", 5), Verify::off);
  engine->step();
  EXPECT_TRUE(device.connected);
  EXPECT_TRUE(sink->online.empty()) << "a connection alone proves nothing";
  engine->step();
  EXPECT_THAT(sink->online, ElementsAre(true));
  EXPECT_EQ(device.count("read input_registers 65280+13"), 0U);
}

TEST_F(DeviceTest, A_broadcast_is_online_without_a_reply_and_nothing_is_read) {
  MapBuilder builder;
  builder.command("valve", 1).unit(0).head().connection.framing = Framing::rtu;
  start(builder);
  run_for(std::chrono::seconds(10));
  EXPECT_THAT(sink->online, ElementsAre(true));
  push("valve", 1);
  run_for(milliseconds(1));
  EXPECT_THAT(device.requests, ElementsAre("connect", "write coil 1"));
}

TEST_F(DeviceTest, What_a_serial_line_is_only_written_to_is_not_read_to_keep_a_connection) {
  MapBuilder builder;
  builder.command("valve", 1).head().connection.serial.device = "/dev/ttyUSB0";
  start(builder, Verify::off);
  run_for(std::chrono::seconds(10));
  EXPECT_THAT(device.requests, ElementsAre("connect"));
}

TEST_F(DeviceTest, A_device_that_answers_nothing_but_the_question_for_its_identity_does_not_flicker) {
  device.is_mute = true;
  start(MapBuilder().holding("a", 5));
  run_for(std::chrono::seconds(20));
  EXPECT_THAT(sink->online, ElementsAre(true, false));
  EXPECT_LE(device.count("connect"), 10U) << "it is asked less and less often";
  device.is_mute = false;
  run_for(std::chrono::seconds(6));
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
}

TEST_F(DeviceTest, A_refused_connection_is_tried_again_with_growing_waits_and_reported_once) {
  device.refuse_connect = NotConnected{"refused"};
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(1550));
  EXPECT_EQ(device.count("connect"), 5U) << "at 0, 100, 300, 700 and 1500 ms";
  EXPECT_EQ(sink->reported("refused"), 1);
  EXPECT_TRUE(sink->online.empty());
}

TEST_F(DeviceTest, A_malformed_reply_is_reported_once_though_its_bytes_differ) {
  for (int i = 0; i < 4; ++i)
    device.next_errors.push_back(BadFrame{"transaction 0, where " + std::to_string(i) + " was asked"});
  start(MapBuilder().holding("a", 5), Verify::off);
  run_for(milliseconds(800));
  EXPECT_EQ(sink->reported("was asked"), 1);
}

TEST_F(DeviceTest, After_a_timeout_the_connection_is_closed_and_made_anew) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  run_for(milliseconds(60));
  EXPECT_FALSE(device.connected) << "a late reply must not be taken for the next one";
  EXPECT_THAT(sink->online, ElementsAre(true, false));
  run_for(milliseconds(150));
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
  EXPECT_EQ(device.count("read input_registers 65280+13"), 2U) << "the identity is asked at every connect";
}

TEST_F(DeviceTest, A_device_that_accepts_and_never_answers_is_tried_less_and_less_often) {
  start(MapBuilder().holding("a", 5), Verify::off);
  for (int i = 0; i < 100; ++i) device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(1550));
  EXPECT_EQ(device.count("connect"), 5U);
}

TEST_F(DeviceTest, Nothing_is_published_while_the_link_is_down) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  device.refuse_connect = NotConnected{"refused"};
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(1000));
  EXPECT_EQ(sink->values["a"].size(), 1U);
}

TEST_F(DeviceTest, An_exception_keeps_the_connection_and_is_reported_when_it_comes_and_goes) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  for (int i = 0; i < 3; ++i)
    device.next_errors.push_back(ExceptionReply{modbus::Exception::server_device_failure});
  run_for(milliseconds(500));
  EXPECT_EQ(device.count("connect"), 1U);
  EXPECT_EQ(sink->reported("a cannot be read now: exception 04 (server device failure)"), 1);
  EXPECT_EQ(sink->reported("a can be read again"), 1);
  EXPECT_EQ(sink->values["a"].size(), 3U);
}

TEST_F(DeviceTest, A_unit_that_its_gateway_cannot_reach_is_offline_and_the_connection_stays) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  for (int i = 0; i < 3; ++i)
    device.next_errors.push_back(ExceptionReply{modbus::Exception::gateway_target_failed_to_respond});
  run_for(milliseconds(600));
  EXPECT_EQ(device.count("connect"), 1U);
  EXPECT_THAT(sink->online, ElementsAre(true, false));
  run_for(milliseconds(300));
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
  EXPECT_EQ(device.count("connect"), 1U);
}

TEST_F(DeviceTest, A_unit_that_is_away_is_asked_less_and_less_often) {
  start(MapBuilder().holding("a", 5));
  for (int i = 0; i < 100; ++i)
    device.next_errors.push_back(ExceptionReply{modbus::Exception::gateway_path_unavailable});
  run_for(milliseconds(1550));
  EXPECT_EQ(device.count("read input_registers 65280+13"), 5U) << "at 0, 100, 300, 700 and 1500 ms";
  EXPECT_EQ(device.count("connect"), 1U);
}

TEST_F(DeviceTest, A_gateway_that_hangs_up_while_its_unit_is_away_is_connected_again) {
  device.next_errors.push_back(ExceptionReply{modbus::Exception::gateway_path_unavailable});
  start(MapBuilder().holding("a", 5));
  engine->step();
  engine->arrived();
  EXPECT_FALSE(device.connected);
  run_for(milliseconds(150));
  EXPECT_EQ(device.count("connect"), 2U);
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(DeviceTest, Other_points_are_read_on_when_a_range_is_rejected) {
  device.missing.insert({Table::holding_registers, 12});
  start(MapBuilder().holding("a", 10).holding("b", 11).holding("c", 12).holding("d", 13));
  run_for(milliseconds(350));
  EXPECT_EQ(sink->values["a"].size(), 4U);
  EXPECT_EQ(sink->values["b"].size(), 4U);
  EXPECT_EQ(sink->values["d"].size(), 4U);
  EXPECT_EQ(sink->values.count("c"), 0U);
  EXPECT_EQ(sink->reported("c is not in the device: exception 02"), 1);
  EXPECT_EQ(device.count("read holding_registers 12+1"), 1U) << "the hole is remembered";
}

TEST_F(DeviceTest, An_area_that_is_given_only_whole_and_rejected_is_reported_once_with_its_points) {
  static const TableRange area[] = {{Table::holding_registers, modbus::Range::of(10, 10)}};
  device.missing.insert({Table::holding_registers, 15});
  auto builder = MapBuilder().holding("a", 9).holding("b", 10).holding("c", 12).holding("d", 19);
  builder.head().read_whole = area;
  start(builder);
  run_for(milliseconds(350));
  EXPECT_EQ(sink->values["a"].size(), 4U);
  EXPECT_EQ(sink->reported("holding_registers 10 to 19 (b, c, d) is not in the device: exception 02"), 1);
  EXPECT_EQ(sink->reported("is not in the device"), 1);
  EXPECT_EQ(sink->no_values, (std::map<std::string, int>{{"b", 1}, {"c", 1}, {"d", 1}}));
  EXPECT_EQ(device.count("read holding_registers 10+10"), 1U);
}

TEST_F(DeviceTest, An_unmapped_address_that_is_rejected_costs_no_point) {
  device.missing.insert({Table::holding_registers, 12});
  auto builder = MapBuilder().holding("a", 11).holding("b", 13);
  builder.head().polling.register_continuous = true;
  start(builder);
  run_for(milliseconds(150));
  EXPECT_EQ(sink->values["a"].size(), 2U);
  EXPECT_EQ(sink->values["b"].size(), 2U);
  EXPECT_EQ(device.count("read holding_registers 11+3"), 1U);
}

TEST_F(DeviceTest, A_hole_is_asked_for_again_after_a_new_connect) {
  device.missing.insert({Table::holding_registers, 12});
  start(MapBuilder().holding("c", 12).holding("far", 100));
  run_for(milliseconds(50));
  device.missing.clear();
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(300));
  EXPECT_FALSE(sink->values["c"].empty());
}

TEST_F(DeviceTest, A_function_that_the_device_does_not_know_is_not_asked_for_again) {
  start(MapBuilder().input("a", 1).input("b", 2).holding("c", 3));
  engine->step();
  device.next_errors.push_back(ExceptionReply{modbus::Exception::illegal_function});
  run_for(milliseconds(350));
  EXPECT_EQ(device.count("read discrete_inputs 1+2"), 1U);
  EXPECT_EQ(sink->values["c"].size(), 4U);
}

TEST_F(DeviceTest, Pauses_that_the_device_needs_are_kept) {
  auto builder = MapBuilder().holding("a", 1).holding("b", 100);
  builder.head().limits.connect_delay = milliseconds(40);
  builder.head().limits.request_gap = milliseconds(10);
  start(builder);
  const Time begin = clock.now();
  engine->step();  // connects, asks for the identity
  EXPECT_EQ(clock.now() - begin, milliseconds(40));
  engine->step();
  engine->step();
  EXPECT_EQ(clock.now() - begin, milliseconds(60));
}

}  // namespace
}  // namespace coupler::host
