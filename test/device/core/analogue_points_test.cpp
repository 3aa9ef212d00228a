// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/analogue_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

Pwm fan() { return {"pwmchip0", 0, std::chrono::microseconds(40)}; }
Iio adc(std::string_view channel) { return {"adc", channel}; }

/// Input registers 0 (INT, mV) and 1 … 2 (REAL, V); holding registers: 0 plain, 1 a PWM in 0.1 %, 2 … 3 a DAC
/// (REAL, V), 4 a PWM in %, which holds when others go to their safe values, 5 one that is safe at 30 %.
fakes::MapBuilder board() {
  fakes::MapBuilder map;
  map.add(Table::input_registers, "millivolts", 0, Type::INT, [](Point& p) {
    p.iio = adc("voltage0");
    p.scale.gain = 0.001;
  });
  map.add(Table::input_registers, "volts", 1, Type::REAL, [](Point& p) { p.iio = adc("voltage1"); });
  map.add(Table::holding_registers, "memory", 0, Type::UINT);
  map.add(Table::holding_registers, "fan", 1, Type::UINT, [](Point& p) {
    p.pwm = fan();
    p.scale.gain = 0.1;
  });
  map.add(Table::holding_registers, "setpoint", 2, Type::REAL, [](Point& p) { p.iio = adc("voltage0"); });
  map.add(Table::holding_registers, "lamp", 4, Type::UINT, [](Point& p) {
    p.pwm = fan();
    p.safe = Safe::hold;
  });
  const auto thirty = map.keep({30});
  map.add(Table::holding_registers, "pump", 5, Type::UINT, [&](Point& p) {
    p.pwm = fan();
    p.safe = Safe::on;
    p.safe_value = thirty;
  });
  return map;
}

Pdu write(int address, std::vector<int> values) {
  Pdu request = pdu(16, {address, static_cast<int>(values.size())});
  request.push_back(static_cast<std::uint8_t>(2 * values.size()));
  for (const int value : values) {
    request.push_back(static_cast<std::uint8_t>(value >> 8));
    request.push_back(static_cast<std::uint8_t>(value));
  }
  return request;
}
Pdu written(int address, int count) { return pdu(16, {address, count}); }
Pdu exception(int function, int code) {
  return {static_cast<std::uint8_t>(function | 0x80), static_cast<std::uint8_t>(code)};
}
Pdu reply(int function, std::initializer_list<int> registers) {
  Pdu bytes = pdu(function, registers);
  bytes.insert(bytes.begin() + 1, static_cast<std::uint8_t>(2 * registers.size()));
  return bytes;
}

TEST(AnaloguePoints, An_input_is_read_from_its_channel) {
  NodeUnderTest node(board().build());
  node.channels.inputs = {{0, 1.2344}, {1, 12.5}};
  EXPECT_EQ(reply(4, {1234, 0x4148, 0}), node.ask(pdu(4, {0, 3})));
}

TEST(AnaloguePoints, An_input_beyond_its_type_reads_as_the_type_s_last_value) {
  NodeUnderTest node(board().build());
  node.channels.inputs = {{0, 99}};
  EXPECT_EQ(reply(4, {0x7FFF}), node.ask(pdu(4, {0, 1})));
}

TEST(AnaloguePoints, One_register_of_a_wide_input_is_read_too) {
  NodeUnderTest node(board().build());
  node.channels.inputs = {{1, 12.5}};
  EXPECT_EQ(reply(4, {0}), node.ask(pdu(4, {2, 1})));
  EXPECT_EQ(reply(4, {0x4148}), node.ask(pdu(4, {1, 1})));
}

TEST(AnaloguePoints, An_input_that_cannot_be_read_is_exception_04_for_who_asks_for_it) {
  NodeUnderTest node(board().build());
  node.channels.inputs = {{0, 1}};
  EXPECT_EQ(exception(4, 4), node.ask(pdu(4, {0, 2})));
  EXPECT_EQ(reply(4, {1000}), node.ask(pdu(4, {0, 1})));
  EXPECT_EQ(1U, node.statistics.hardware_errors);
}

TEST(AnaloguePoints, A_write_drives_its_outputs_and_only_those) {
  NodeUnderTest node(board().build());
  EXPECT_EQ(written(0, 4), node.ask(write(0, {7, 505, 0x4148, 0})));
  EXPECT_THAT(node.channels.driven, ElementsAre(Pair(1, 50.5), Pair(2, 12.5)));
  EXPECT_EQ(reply(3, {7, 505, 0x4148, 0}), node.ask(pdu(3, {0, 4})));
}

TEST(AnaloguePoints, A_register_without_a_channel_drives_nothing) {
  NodeUnderTest node(board().build());
  EXPECT_EQ(pdu(6, {0, 7}), node.ask(pdu(6, {0, 7})));
  EXPECT_THAT(node.channels.driven, IsEmpty());
}

TEST(AnaloguePoints, A_value_out_of_range_is_exception_03_before_anything_is_driven) {
  NodeUnderTest node(board().build());
  EXPECT_EQ(exception(16, 3), node.ask(write(1, {505, 0x4148, 0, 101})));
  EXPECT_EQ(exception(6, 3), node.ask(pdu(6, {1, 1001})));
  EXPECT_THAT(node.channels.driven, IsEmpty());
  EXPECT_EQ(reply(3, {0, 0, 0, 0}), node.ask(pdu(3, {1, 4})));
  EXPECT_EQ(0U, node.statistics.hardware_errors);
}

TEST(AnaloguePoints, What_is_no_finite_number_is_exception_03) {
  NodeUnderTest node(board().build());
  for (const int high : {0x7FC0, 0x7F80, 0xFF80}) EXPECT_EQ(exception(16, 3), node.ask(write(2, {high, 0})));
  EXPECT_THAT(node.channels.driven, IsEmpty());
}

TEST(AnaloguePoints, A_write_to_a_part_of_a_wide_value_is_exception_02) {
  NodeUnderTest node(board().build());
  EXPECT_EQ(exception(16, 2), node.ask(write(1, {0, 0x4148})));
  EXPECT_EQ(exception(6, 2), node.ask(pdu(6, {3, 0})));
  EXPECT_EQ(exception(22, 2), node.ask(pdu(22, {2, 0xFFFF, 0})));
  EXPECT_THAT(node.channels.driven, IsEmpty());
}

TEST(AnaloguePoints, An_output_that_fails_is_exception_04_and_the_ones_before_it_go_back) {
  NodeUnderTest node(board().build());
  node.ask(write(1, {100, 0x3F80, 0}));
  node.channels.driven.clear();
  node.channels.broken = {4};
  EXPECT_EQ(exception(16, 4), node.ask(write(0, {7, 505, 0x4148, 0, 50})));
  EXPECT_THAT(node.channels.driven,
              ElementsAre(Pair(1, 50.5), Pair(2, 12.5), Pair(4, 50), Pair(1, 10), Pair(2, 1)));
  EXPECT_EQ(reply(3, {0, 100, 0x3F80, 0, 0}), node.ask(pdu(3, {0, 5})));
  EXPECT_EQ(1U, node.statistics.hardware_errors);
}

TEST(AnaloguePoints, A_value_that_the_hardware_refuses_is_exception_03_and_nothing_is_left_of_the_write) {
  NodeUnderTest node(board().build());
  node.channels.picky = {2};
  EXPECT_EQ(exception(16, 3), node.ask(write(1, {505, 0x4148, 0})));
  EXPECT_THAT(node.channels.outputs, UnorderedElementsAre(Pair(1, 0)));
  EXPECT_EQ(reply(3, {0, 0, 0}), node.ask(pdu(3, {1, 3})));
  EXPECT_EQ(0U, node.statistics.hardware_errors);
}

TEST(AnaloguePoints, FC_22_and_23_drive_outputs_too) {
  NodeUnderTest node(board().build());
  EXPECT_EQ(pdu(22, {1, 0, 250}), node.ask(pdu(22, {1, 0, 250})));
  EXPECT_DOUBLE_EQ(25, node.channels.outputs[1]);
  EXPECT_EQ(reply(23, {40}), node.ask(pdu(23, {4, 1, 4, 1}, {2, 0, 40})));
  EXPECT_DOUBLE_EQ(40, node.channels.outputs[4]);
}

TEST(AnaloguePoints, The_safe_state_is_off_a_value_or_hold_and_the_image_shows_it) {
  NodeUnderTest node(board().build());
  node.ask(write(1, {505, 0x4148, 0, 50, 60}));
  EXPECT_TRUE(node.analogue.drive_safe());
  EXPECT_THAT(node.channels.outputs, UnorderedElementsAre(Pair(1, 0), Pair(2, 0), Pair(4, 50), Pair(5, 30)));
  EXPECT_EQ(reply(3, {0, 0, 0, 50, 30}), node.ask(pdu(3, {1, 5})));
}

TEST(AnaloguePoints, An_output_that_fails_keeps_no_other_from_its_safe_state) {
  NodeUnderTest node(board().build());
  node.ask(write(1, {505, 0x4148, 0, 50, 60}));
  node.channels.broken = {1};
  EXPECT_FALSE(node.analogue.drive_safe());
  EXPECT_THAT(node.channels.outputs,
              UnorderedElementsAre(Pair(1, 50.5), Pair(2, 0), Pair(4, 50), Pair(5, 30)));
  EXPECT_EQ(reply(3, {505, 0, 0, 50, 30}), node.ask(pdu(3, {1, 5})));
}

TEST(AnaloguePoints, A_safe_state_that_an_unplugged_output_missed_is_what_it_comes_back_with) {
  NodeUnderTest node(board().build());
  node.ask(write(1, {505, 0x4148, 0, 50, 60}));
  node.channels.unplugged = {1};
  EXPECT_FALSE(node.analogue.drive_safe());
  node.channels.unplugged.clear();
  EXPECT_TRUE(node.analogue.drive_all(false));
  EXPECT_DOUBLE_EQ(0, node.channels.outputs[1]);
}

TEST(AnaloguePoints, A_pwm_that_is_off_is_at_0_percent_whatever_its_scale) {
  fakes::MapBuilder map;
  map.add(Table::holding_registers, "fan", 0, Type::INT, [](Point& p) {
    p.pwm = fan();
    p.scale = {1, 50};
  });
  NodeUnderTest node(map.build());
  EXPECT_TRUE(node.analogue.drive_safe());
  EXPECT_DOUBLE_EQ(0, node.channels.outputs[0]);
  EXPECT_EQ(reply(3, {-50}), node.ask(pdu(3, {0, 1})));
}

TEST(AnaloguePoints, At_the_start_outputs_are_driven_to_what_the_image_says) {
  fakes::MapBuilder map;
  const auto twenty = map.keep({20});
  map.add(Table::holding_registers, "fan", 0, Type::UINT, [&](Point& p) {
    p.pwm = fan();
    p.initial = twenty;
  });
  map.add(Table::holding_registers, "other", 1, Type::UINT, [&](Point& p) { p.pwm = fan(); });
  NodeUnderTest node(map.build());
  node.channels.broken = {0};
  EXPECT_FALSE(node.analogue.drive_all(false));
  EXPECT_THAT(node.channels.driven, ElementsAre(Pair(0, 20), Pair(1, 0)));
}

TEST(AnaloguePoints, One_output_is_driven_as_the_image_says_or_to_its_safe_state) {
  NodeUnderTest node(board().build());
  node.ask(write(4, {50, 60}));
  node.channels.driven.clear();
  for (const char* name : {"lamp", "pump"}) EXPECT_TRUE(node.analogue.drive(*find(node.map, name), false));
  for (const char* name : {"lamp", "pump"}) EXPECT_TRUE(node.analogue.drive(*find(node.map, name), true));
  EXPECT_THAT(node.channels.driven, ElementsAre(Pair(4, 50), Pair(5, 60), Pair(4, 50), Pair(5, 30)));
  EXPECT_EQ(reply(3, {50, 30}), node.ask(pdu(3, {4, 2})));
}

TEST(AnaloguePoints, A_write_to_an_output_arms_the_watchdog_which_drives_lines_and_channels) {
  auto map = board();
  map.watchdog({std::chrono::milliseconds(500), Watchdog::FedBy::any, Watchdog::Recovery::manual});
  NodeUnderTest node(map.build());
  node.ask(pdu(6, {0, 7}));
  EXPECT_EQ(std::nullopt, node.handler.time_until_due(node.now));
  node.ask(pdu(6, {1, 505}));
  node.now += std::chrono::milliseconds(500);
  node.handler.tick(node.now);
  EXPECT_EQ(1, node.lines.safe_calls);
  EXPECT_DOUBLE_EQ(0, node.channels.outputs[1]);
  EXPECT_EQ(exception(6, 4), node.ask(pdu(6, {1, 505})));
  EXPECT_EQ(pdu(6, {0, 8}), node.ask(pdu(6, {0, 8})));
  EXPECT_DOUBLE_EQ(0, node.channels.outputs[1]);
}

}  // namespace
}  // namespace coupler::device
