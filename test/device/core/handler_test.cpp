// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/map/fingerprint.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using modbus::Range;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;
using testing::Pair;

MapPtr sample() {
  return MapBuilder()
      .many(Table::coils, 0, 20)
      .many(Table::discrete_inputs, 0, 20)
      .many(Table::input_registers, 0, 10)
      .many(Table::holding_registers, 0, 10)
      .many(Table::holding_registers, 100, 2)
      .build();
}

class Handling : public testing::Test {
 protected:
  NodeUnderTest node{sample()};
};

TEST_F(Handling, A_coil_reads_as_it_was_written) {
  EXPECT_THAT(node.ask(pdu(5, {3, 0xFF00})), ElementsAreArray(pdu(5, {3, 0xFF00})));
  EXPECT_THAT(node.ask(pdu(1, {0, 10})), ElementsAre(1, 2, 0x08, 0));
  EXPECT_THAT(node.ask(pdu(5, {3, 0})), ElementsAreArray(pdu(5, {3, 0})));
  EXPECT_THAT(node.ask(pdu(1, {0, 10})), ElementsAre(1, 2, 0, 0));
}

TEST_F(Handling, Coils_are_driven_in_one_step_before_they_are_acknowledged) {
  EXPECT_THAT(node.ask(pdu(15, {2, 10}, {2, 0xCD, 0x01})), ElementsAreArray(pdu(15, {2, 10})));
  EXPECT_THAT(node.lines.writes(),
              ElementsAre(Pair(Range::of(2, 10), ElementsAre(1, 0, 1, 1, 0, 0, 1, 1, 1, 0))));
  EXPECT_THAT(node.ask(pdu(1, {2, 10})), ElementsAre(1, 2, 0xCD, 0x01));
}

TEST_F(Handling, A_write_that_the_hardware_refuses_is_answered_04_and_leaves_no_trace) {
  node.ask(pdu(15, {0, 4}, {1, 0x05}));
  node.lines.broken = true;
  EXPECT_THAT(node.ask(pdu(5, {1, 0xFF00})), ElementsAre(0x85, 4));
  EXPECT_THAT(node.ask(pdu(15, {0, 4}, {1, 0x0A})), ElementsAre(0x8F, 4));
  EXPECT_THAT(node.ask(pdu(1, {0, 4})), ElementsAre(1, 1, 0x05));
  EXPECT_EQ(node.statistics.hardware_errors, 2U);
}

constexpr NamedValue modes[] = {{0, "off"}, {7, "auto"}};

/// A REAL from 0 to 21.7 in 0 and 1, a mode in 2, an array from 0 to 9 in 3 to 5, two bytes, one of them to
/// 10, in 6.
MapPtr limited() {
  return MapBuilder()
      .add(Table::holding_registers, "pressure", 0, codec::Type::REAL,
           [](Point& point) {
             point.format.order = codec::Order::ABCD;
             point.bounds = {0, 21.7};
           })
      .add(Table::holding_registers, "mode", 2, codec::Type::UINT, [](Point& point) { point.values = modes; })
      .add(Table::holding_registers, "profile", 3, codec::Type::INT,
           [](Point& point) {
             point.count = 3;
             point.bounds = {0, 9};
           })
      .add(Table::holding_registers, "low", 6, codec::Type::USINT,
           [](Point& point) {
             point.format.half = codec::Half::low;
             point.bounds.max = 10;
           })
      .add(Table::holding_registers, "high", 6, codec::Type::USINT,
           [](Point& point) { point.format.half = codec::Half::high; })
      .build();
}

TEST(AllowedValuesOfANode, What_the_map_does_not_allow_is_exception_03_and_changes_nothing) {
  NodeUnderTest node{limited()};
  EXPECT_THAT(node.ask(pdu(16, {0, 2}, {4, 0x41, 0xAD, 0x99, 0x9A})),
              ElementsAreArray(pdu(16, {0, 2})));                                       // 21.7
  EXPECT_THAT(node.ask(pdu(16, {0, 2}, {4, 0x41, 0xAE, 0, 0})), ElementsAre(0x90, 3));  // 21.75
  EXPECT_THAT(node.ask(pdu(16, {0, 2}, {4, 0x7F, 0xC0, 0, 0})), ElementsAre(0x90, 3));  // NaN
  EXPECT_THAT(node.ask(pdu(6, {0, 0xBF80})), ElementsAre(0x86, 3));  // a half of it makes it negative
  EXPECT_THAT(node.ask(pdu(3, {0, 2})), ElementsAre(3, 4, 0x41, 0xAD, 0x99, 0x9A));
  EXPECT_THAT(node.ask(pdu(6, {2, 7})), ElementsAreArray(pdu(6, {2, 7})));
  EXPECT_THAT(node.ask(pdu(6, {2, 1})), ElementsAre(0x86, 3));
  EXPECT_THAT(node.ask(pdu(22, {2, 0, 8})), ElementsAre(0x96, 3));
  EXPECT_THAT(node.ask(pdu(23, {2, 1, 2, 1}, {2, 0, 8})), ElementsAre(0x97, 3));
  EXPECT_THAT(node.ask(pdu(3, {2, 1})), ElementsAre(3, 2, 0, 7));
}

TEST(AllowedValuesOfANode, An_array_is_looked_at_value_by_value) {
  NodeUnderTest node{limited()};
  EXPECT_THAT(node.ask(pdu(16, {3, 3}, {6, 0, 1, 0, 9, 0, 3})), ElementsAreArray(pdu(16, {3, 3})));
  EXPECT_THAT(node.ask(pdu(16, {4, 2}, {4, 0, 2, 0, 10})), ElementsAre(0x90, 3));
  EXPECT_THAT(node.ask(pdu(6, {5, 0xFFFF})), ElementsAre(0x86, 3));
  EXPECT_THAT(node.ask(pdu(3, {3, 3})), ElementsAre(3, 6, 0, 1, 0, 9, 0, 3));
}

TEST(AllowedValuesOfANode, A_part_of_a_register_is_looked_at_if_its_own_bits_change) {
  NodeUnderTest node{limited()};
  EXPECT_THAT(node.ask(pdu(6, {6, 0xFF0A})), ElementsAreArray(pdu(6, {6, 0xFF0A})));
  EXPECT_THAT(node.ask(pdu(6, {6, 0xFF0B})), ElementsAre(0x86, 3));
  EXPECT_THAT(node.ask(pdu(6, {6, 0x200A})), ElementsAreArray(pdu(6, {6, 0x200A})));
}

TEST_F(Handling, A_discrete_input_reads_its_lines_level) {
  node.lines.set_input(1, 1);
  node.lines.set_input(9, 1);
  EXPECT_THAT(node.ask(pdu(2, {0, 10})), ElementsAre(2, 2, 0x02, 0x02));
  node.lines.set_input(1, 0);
  EXPECT_THAT(node.ask(pdu(2, {1, 9})), ElementsAre(2, 2, 0x00, 0x01));
}

TEST_F(Handling, An_input_that_cannot_be_read_is_answered_04_and_other_tables_go_on) {
  node.lines.broken = true;
  EXPECT_THAT(node.ask(pdu(2, {0, 1})), ElementsAre(0x82, 4));
  EXPECT_THAT(node.ask(pdu(1, {0, 1})), ElementsAre(1, 1, 0));
  EXPECT_THAT(node.ask(pdu(6, {0, 7})), ElementsAreArray(pdu(6, {0, 7})));
}

TEST_F(Handling, Registers_read_as_they_were_written) {
  EXPECT_THAT(node.ask(pdu(6, {1, 0x1234})), ElementsAreArray(pdu(6, {1, 0x1234})));
  EXPECT_THAT(node.ask(pdu(16, {2, 2}, {4, 0xAB, 0xCD, 0, 1})), ElementsAreArray(pdu(16, {2, 2})));
  EXPECT_THAT(node.ask(pdu(3, {0, 4})), ElementsAre(3, 8, 0, 0, 0x12, 0x34, 0xAB, 0xCD, 0, 1));
  EXPECT_THAT(node.ask(pdu(4, {0, 1})), ElementsAre(4, 2, 0, 0));
}

TEST_F(Handling, Query_data_comes_back) {
  EXPECT_THAT(node.ask(pdu(8, {0, 0xA537, 1})), ElementsAreArray(pdu(8, {0, 0xA537, 1})));
}

TEST_F(Handling, The_identification_names_the_map_and_its_fingerprint) {
  const Pdu name = node.ask({43, 14, 4, 1});
  EXPECT_EQ(std::string(name.begin() + 9, name.end()), node.map.name);
  const Pdu model = node.ask({43, 14, 4, 5});
  EXPECT_EQ(std::string(model.begin() + 9, model.end()), fingerprint_text(node.map.fingerprint));
}

TEST_F(Handling, A_mask_write_changes_the_bits_it_names) {
  node.ask(pdu(6, {4, 0x0012}));
  EXPECT_THAT(node.ask(pdu(22, {4, 0x00F2, 0x0025})), ElementsAreArray(pdu(22, {4, 0x00F2, 0x0025})));
  EXPECT_THAT(node.ask(pdu(3, {4, 1})), ElementsAre(3, 2, 0, 0x17)) << "the example of MAP 6.16";
}

TEST_F(Handling, A_read_write_writes_first) {
  EXPECT_THAT(node.ask(pdu(23, {0, 2, 1, 1}, {2, 0x12, 0x34})), ElementsAre(23, 4, 0, 0, 0x12, 0x34));
}

TEST_F(Handling, An_address_outside_the_map_is_02_and_nothing_of_the_request_is_done) {
  for (const int function : {1, 2})
    EXPECT_THAT(node.ask(pdu(function, {19, 2})), ElementsAre(function | 0x80, 2));
  for (const int function : {3, 4})
    EXPECT_THAT(node.ask(pdu(function, {9, 2})), ElementsAre(function | 0x80, 2));
  EXPECT_THAT(node.ask(pdu(5, {20, 0})), ElementsAre(0x85, 2));
  EXPECT_THAT(node.ask(pdu(15, {19, 2}, {1, 3})), ElementsAre(0x8F, 2));
  EXPECT_THAT(node.ask(pdu(6, {10, 1})), ElementsAre(0x86, 2));
  EXPECT_THAT(node.ask(pdu(16, {9, 2}, {4, 0, 1, 0, 2})), ElementsAre(0x90, 2));
  EXPECT_THAT(node.ask(pdu(22, {10, 0, 1})), ElementsAre(0x96, 2));
  EXPECT_THAT(node.ask(pdu(23, {10, 1, 0, 1}, {2, 0, 1})), ElementsAre(0x97, 2));
  EXPECT_THAT(node.ask(pdu(23, {0, 1, 10, 1}, {2, 0, 1})), ElementsAre(0x97, 2));
  EXPECT_THAT(node.lines.writes(), IsEmpty());
  EXPECT_THAT(node.ask(pdu(3, {0, 10})), ElementsAreArray(pdu(3, {0x1400, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {0})));
}

TEST_F(Handling, Requests_and_exceptions_are_counted) {
  node.ask(pdu(3, {0, 1}));
  node.ask(pdu(3, {50, 1}));
  node.ask(pdu(99, {}));
  EXPECT_EQ(node.statistics.requests, 3U);
  EXPECT_EQ(node.statistics.exceptions, 2U);
  EXPECT_EQ(node.statistics.hardware_errors, 0U);
}

}  // namespace
}  // namespace coupler::device
