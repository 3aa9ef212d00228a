// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/core/server.hpp"
#include "coupler/map/field_side.hpp"
#include "coupler/map/identity.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using testing::IsEmpty;

constexpr Pdu::value_type no_address = 2;

/// The server of a node with two outputs and four inputs of each kind of table.
class FieldSide : public testing::Test {
 protected:
  FieldSide()
      : node_(MapBuilder()
                  .many(Table::coils, 0, 2)
                  .many(Table::discrete_inputs, 0, 4)
                  .many(Table::input_registers, 0, 3)
                  .add(Table::input_registers, "count", 3, Type::UINT,
                       [](Point& point) { point.counter.input = "discrete_inputs_0"; })
                  .many(Table::holding_registers, 0, 2)
                  .watchdog({std::chrono::milliseconds(100), {}, {}})
                  .build()) {
    node_.lines.simulated = true;
    node_.lines.outputs = {{0, {}}, {1, {}}};
  }

  Pdu ask(std::uint8_t unit, const Pdu& request) {
    std::array<std::uint8_t, modbus::max_adu_size> adu{};
    const std::size_t size = server_.answer({0xBEEF, unit, request}, node_.session, node_.now, adu);
    return size == 0 ? Pdu() : Pdu(adu.data() + modbus::mbap_size, adu.data() + size);
  }
  Pdu play(const Pdu& request) { return ask(field_unit, request); }

  static Pdu refused(int function, std::uint8_t why) {
    return {static_cast<std::uint8_t>(function | 0x80), why};
  }

  NodeUnderTest node_;
  Server server_{1, node_.handler, node_.statistics};
};

TEST_F(FieldSide, What_is_written_there_is_what_the_node_reads) {
  EXPECT_EQ(play(pdu(5, {1, 0xFF00})), pdu(5, {1, 0xFF00}));
  EXPECT_EQ(play(pdu(16, {1, 2}, {4, 0x12, 0x34, 0x56, 0x78})), pdu(16, {1, 2}));
  EXPECT_EQ(ask(1, pdu(2, {0, 4})), Pdu({2, 1, 0b0010}));
  EXPECT_EQ(ask(1, pdu(4, {0, 3})), Pdu({4, 6, 0, 0, 0x12, 0x34, 0x56, 0x78}));
  EXPECT_EQ(play(pdu(1, {0, 4})), Pdu({1, 1, 0b0010})) << "and it reads back";
  EXPECT_EQ(play(pdu(3, {1, 1})), Pdu({3, 2, 0x12, 0x34}));
}

TEST_F(FieldSide, What_the_node_drives_is_read_there_and_not_written) {
  ask(1, pdu(5, {1, 0xFF00}));
  ask(1, pdu(6, {0, 7}));
  EXPECT_EQ(play(pdu(2, {0, 2})), Pdu({2, 1, 0b10}));
  EXPECT_EQ(play(pdu(4, {0, 1})), Pdu({4, 2, 0, 7}));
}

TEST_F(FieldSide, An_input_with_a_value_from_elsewhere_is_refused) {
  node_.lines.wired = 2;
  EXPECT_EQ(play(pdu(5, {2, 0xFF00})), refused(5, no_address));
  EXPECT_EQ(play(pdu(15, {1, 2}, {1, 3})), refused(15, no_address));
  EXPECT_EQ(ask(1, pdu(2, {0, 4})), Pdu({2, 1, 0})) << "none of them";
  EXPECT_EQ(play(pdu(6, {3, 1})), refused(6, no_address)) << "a counter";
  EXPECT_EQ(play(pdu(6, {identity::reserved.start(), 1})), refused(6, no_address));
  EXPECT_EQ(play(pdu(3, {identity::reserved.start(), 1})), refused(3, no_address));
  EXPECT_EQ(play(pdu(5, {4, 0xFF00})), refused(5, no_address)) << "not mapped";
  EXPECT_EQ(play(pdu(22, {0, 0, 0})), refused(22, 1));
}

TEST_F(FieldSide, It_is_for_clients_that_may_read_every_point) {
  NodeUnderTest node(
      MapBuilder().many(Table::discrete_inputs, 0, 2).everybody_may({"discrete_inputs_0"}, {}).build());
  node.lines.simulated = true;
  std::array<std::uint8_t, modbus::max_adu_size> adu{};
  for (const Pdu& request : {pdu(5, {0, 0xFF00}), pdu(1, {0, 1})}) {
    ASSERT_EQ(node.handler.handle_from_field(request, node.session, node.now, adu), 2U);
    EXPECT_EQ(adu[1], 1);
  }
}

TEST_F(FieldSide, The_identity_says_that_there_is_one) {
  const auto functions = [](NodeUnderTest& node) {
    constexpr std::uint16_t at = identity::reserved.start() + identity::at_functions;
    return node.ask(pdu(4, {at, 1}))[3] & identity::Functions::has_field_side_bit;
  };
  node_.handler.set_machine({});
  EXPECT_NE(functions(node_), 0);
  node_.lines.simulated = false;
  node_.handler.set_machine({});
  EXPECT_EQ(functions(node_), 0);
  NodeUnderTest own(MapBuilder().coil("lamp", 0).unit(field_unit).build());
  own.lines.simulated = true;
  own.handler.set_machine({});
  EXPECT_EQ(functions(own), 0);
}

TEST_F(FieldSide, It_feeds_no_watchdog) {
  ask(1, pdu(5, {0, 0xFF00}));
  node_.now += std::chrono::milliseconds(60);
  play(pdu(1, {0, 1}));
  play(pdu(5, {0, 0xFF00}));
  node_.now += std::chrono::milliseconds(60);
  node_.handler.tick(node_.now);
  EXPECT_EQ(node_.watchdog.state(), OutputWatchdog::State::expired);
}

TEST_F(FieldSide, Who_waits_for_changes_is_told) {
  node_.handler.tell_changes(1, node_.now);
  Pdu wait(modbus::changes_request_size);
  modbus::build_changes_request({1000, 1, 0}, wait);
  EXPECT_THAT(ask(1, wait), IsEmpty());
  ClientSession other;
  std::array<std::uint8_t, modbus::max_adu_size> adu{};
  const Pdu press = pdu(5, {1, 0xFF00});
  EXPECT_NE(server_.answer({1, field_unit, press}, other, node_.now, adu), 0U);
  EXPECT_NE(server_.answer_waiting(node_.session, node_.now, adu), 0U);
}

TEST_F(FieldSide, Real_hardware_has_none) {
  node_.lines.simulated = false;
  EXPECT_THAT(play(pdu(5, {1, 0xFF00})), IsEmpty());
  EXPECT_EQ(node_.statistics.foreign_units, 1U);
}

TEST_F(FieldSide, A_node_whose_own_unit_it_is_has_none) {
  Server server(field_unit, node_.handler, node_.statistics);
  std::array<std::uint8_t, modbus::max_adu_size> adu{};
  const Pdu press = pdu(5, {1, 0xFF00});
  server.answer({1, field_unit, press}, node_.session, node_.now, adu);
  EXPECT_EQ(node_.lines.outputs[1].level, 1) << "it is the node's own coil";
}

}  // namespace
}  // namespace coupler::device
