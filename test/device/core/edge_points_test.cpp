// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;

constexpr auto coils = Table::coils;
constexpr auto inputs = Table::discrete_inputs;
constexpr auto holding = Table::holding_registers;

auto counts(Edge edge, codec::Order order = codec::Order::ABCD) {
  return [=](Point& p) {
    p.counter = {"pulse", edge};
    p.format.order = order;
  };
}

auto latches(Edge edge, std::uint8_t bit = 0) {
  return [=](Point& p) {
    p.latched = {"pulse", edge};
    p.format.bit = bit;
  };
}

MapPtr machine() {
  return MapBuilder()
      .add(coils, "seen", 1, Type::BOOL, latches(Edge::falling))
      .add(coils, "lamp", 2, Type::BOOL)
      .add(inputs, "other", 3, Type::BOOL)
      .add(inputs, "pulse", 4, Type::BOOL)
      .add(Table::input_registers, "ups", 0, Type::UINT, counts(Edge::rising))
      .add(holding, "downs", 0, Type::UDINT, counts(Edge::falling, codec::Order::CDAB))
      .add(holding, "all", 2, Type::LINT, counts(Edge::both))
      .add(holding, "spare", 6, Type::WORD)
      .add(holding, "flag", 7, Type::BOOL, latches(Edge::rising, 3))
      .add(holding, "mode", 7, Type::BOOL, [](Point& p) { p.format.bit = 4; })
      .build();
}

struct Counting : testing::Test {
  void happen(Edges edges, std::uint16_t input = 4) { node.lines.edges.emplace_back(input, edges); }
  std::uint16_t read(Table table, int address) {
    const Pdu reply = node.ask(pdu(table == coils ? 1 : table == holding ? 3 : 4, {address, 1}));
    return static_cast<std::uint16_t>(holds_bits(table) ? reply.at(2) : reply.at(2) << 8 | reply.at(3));
  }
  Pdu write(std::uint16_t address, std::vector<int> registers) {
    Pdu rest{static_cast<std::uint8_t>(2 * registers.size())};
    for (const int value : registers) {
      rest.push_back(static_cast<std::uint8_t>(value >> 8));
      rest.push_back(static_cast<std::uint8_t>(value));
    }
    return node.ask(pdu(16, {address, static_cast<int>(registers.size())}, rest));
  }

  NodeUnderTest node{machine()};
};

const Pdu refused_address{0x90, 2};

TEST_F(Counting, A_counter_counts_its_kind_of_edge_before_the_request_that_asks_is_answered) {
  happen({3, 2, 0});
  EXPECT_EQ(read(Table::input_registers, 0), 3);
  EXPECT_EQ(read(holding, 0), 2) << "CDAB: the low word comes first";
  EXPECT_EQ(read(holding, 1), 0);
  EXPECT_EQ(read(holding, 5), 5);
  happen({9, 9, 0}, 3);
  EXPECT_EQ(read(Table::input_registers, 0), 3) << "another input's edges";
}

TEST_F(Counting, A_counter_is_preset_as_a_whole_carries_and_wraps) {
  EXPECT_EQ(write(0, {0xFFFF, 0x0001})[0], 16);
  happen({0, 1, 0});
  EXPECT_EQ(read(holding, 0), 0);
  EXPECT_EQ(read(holding, 1), 2);
  EXPECT_EQ(write(2, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFE})[0], 16);
  happen({2, 1, 0});
  for (const int address : {2, 3, 4}) EXPECT_EQ(read(holding, address), 0);
  EXPECT_EQ(read(holding, 5), 1);
}

TEST_F(Counting, A_write_to_a_part_of_a_counter_is_exception_02_and_writes_nothing) {
  EXPECT_EQ(write(1, {7}), refused_address);
  EXPECT_EQ(write(0, {7, 7, 7}), refused_address) << "part of the second one";
  EXPECT_EQ(write(5, {7, 7}), refused_address);
  EXPECT_EQ(node.ask(pdu(6, {0, 7})), (Pdu{0x86, 2}));
  EXPECT_EQ(node.ask(pdu(22, {5, 0, 7})), (Pdu{0x96, 2}));
  EXPECT_EQ(node.ask(pdu(23, {6, 1, 5, 2}, {4, 0, 7, 0, 7})), (Pdu{0x97, 2}));
  for (const int address : {0, 1, 2, 5, 6}) EXPECT_EQ(read(holding, address), 0);
  EXPECT_EQ(write(0, {1, 2, 3, 4, 5, 6, 7})[0], 16) << "several whole ones at once";
}

TEST_F(Counting, A_latched_coil_is_set_by_its_edge_stays_and_is_cleared_by_writing_0) {
  EXPECT_EQ(read(coils, 1), 0);
  happen({1, 1, 0});
  EXPECT_EQ(read(coils, 1), 1);
  EXPECT_EQ(read(coils, 1), 1) << "reading does not clear it";
  node.ask(pdu(5, {1, 0}));
  EXPECT_EQ(read(coils, 1), 0);
  happen({1, 0, 0});
  EXPECT_EQ(read(coils, 1), 0) << "not its kind of edge";
}

TEST_F(Counting, Writing_1_to_a_latch_leaves_it_as_it_is) {
  node.ask(pdu(15, {1, 2}, {1, 0b11}));
  EXPECT_EQ(read(coils, 1), 0);
  EXPECT_EQ(read(coils, 2), 1) << "its neighbour is an ordinary coil";
  happen({1, 1, 0});
  node.ask(pdu(15, {1, 2}, {1, 0b01}));
  EXPECT_EQ(read(coils, 1), 1);
}

TEST_F(Counting, A_latched_bit_shares_its_register_with_ordinary_ones) {
  write(7, {0b11000});
  EXPECT_EQ(read(holding, 7), 0b10000);
  happen({1, 0, 0});
  EXPECT_EQ(read(holding, 7), 0b11000);
  write(7, {0b01000});
  EXPECT_EQ(read(holding, 7), 0b01000);
  node.ask(pdu(22, {7, 0xFFEF, 0x0010}));
  EXPECT_EQ(read(holding, 7), 0b11000);
  node.ask(pdu(22, {7, 0x0000, 0x0010}));
  EXPECT_EQ(read(holding, 7), 0b10000);
}

TEST_F(Counting, Lost_events_are_counted_and_shown) {
  happen({1, 1, 5});
  happen({0, 0, 2}, 3);
  EXPECT_EQ(read(Table::input_registers, 0xFF19), 0);
  EXPECT_EQ(read(Table::input_registers, 0xFF1A), 7);
}

}  // namespace
}  // namespace coupler::device
