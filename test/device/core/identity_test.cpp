// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "coupler/codec/number.hpp"
#include "coupler/device/core/identity.hpp"
#include "coupler/map/identity.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::ElementsAre;

/// The registers of an FC 4 reply.
std::vector<std::uint16_t> registers(const Pdu& reply) {
  std::vector<std::uint16_t> values;
  for (std::size_t i = 2; i + 1 < reply.size(); i += 2) values.push_back(modbus::get_u16(&reply[i]));
  return values;
}

TEST(Identity, The_driver_recognises_the_node_and_its_map) {
  NodeUnderTest node(MapBuilder().many(Table::coils, 0, 3).text("name: device\n").build());
  const auto head = registers(node.ask(pdu(4, {0xFF00, identity::head_size})));
  ASSERT_EQ(head.size(), identity::head_size);
  std::array<std::uint16_t, identity::head_size> area{};
  std::copy(head.begin(), head.end(), area.begin());
  const auto read = identity::read_head(area);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->fingerprint, node.map.fingerprint);
  EXPECT_EQ(read->map_size, 13U);
  EXPECT_EQ(read->map_crc, node.map.text_crc);
}

TEST(Identity, The_counters_are_up_to_date_when_they_are_read) {
  NodeUnderTest node(MapBuilder().build());
  node.ask(pdu(3, {0, 1}));  // 02
  node.statistics.connections = 0x12345;
  node.now += std::chrono::seconds(70000);
  const auto area = registers(node.ask(pdu(4, {0xFF00, identity::size})));
  ASSERT_EQ(area.size(), identity::size);
  const auto counter = [&](std::size_t at) {
    return codec::decode<std::uint32_t>(&area[at], codec::Order::ABCD);
  };
  EXPECT_EQ(counter(identity::at_uptime), 70000U);
  EXPECT_EQ(counter(15), 2U);
  EXPECT_EQ(counter(17), 1U);
  EXPECT_EQ(counter(19), 0x12345U);
  EXPECT_EQ(counter(21), 0U);
}

TEST(Identity, Exceptions_are_counted_by_their_code) {
  NodeUnderTest node(MapBuilder().many(Table::coils, 0, 1).build());
  node.ask(pdu(99, {}));                                 // 01
  for (int i = 0; i < 2; ++i) node.ask(pdu(3, {0, 1}));  // 02
  for (int i = 0; i < 3; ++i) node.ask(pdu(3, {0, 0}));  // 03
  node.lines.broken = true;
  for (int i = 0; i < 4; ++i) node.ask(pdu(5, {0, 0}));  // 04
  const auto area = registers(node.ask(pdu(4, {0xFF00, identity::size})));
  for (std::uint32_t code = 1; code <= 4; ++code) {
    const auto* counter = &area.at(27 + 2 * (code - 1));
    EXPECT_EQ(codec::decode<std::uint32_t>(counter, codec::Order::ABCD), code);
  }
}

TEST(Identity, What_happens_to_connections_is_counted) {
  NodeUnderTest node(MapBuilder().build());
  node.statistics.refusals = 1;
  node.statistics.evictions = 2;
  node.statistics.foreign_units = 3;
  node.statistics.bad_frames = 4;
  node.statistics.timeouts = 0x50000;
  const auto area = registers(node.ask(pdu(4, {0xFF23, 10})));
  EXPECT_THAT(area, ElementsAre(0, 1, 0, 2, 0, 3, 0, 4, 5, 0));
}

TEST(Identity, A_node_that_was_told_its_machine_tells_it) {
  NodeUnderTest node(MapBuilder().build());
  node.handler.set_machine(identity::machine_of("cell-7", 0x0123456789ABCDEF));
  const auto further =
      registers(node.ask(pdu(4, {0xFF00 + identity::at_further, 1 + identity::further_size})));
  ASSERT_EQ(further.size(), 40U);
  EXPECT_EQ(further[0], 39U);
  const identity::Machine machine = identity::read_further({further.data() + 1, 39}).machine;
  EXPECT_EQ(machine.serial, 0x0123456789ABCDEFU);
  EXPECT_EQ(identity::hostname_of(machine), "cell-7");
  EXPECT_THAT(node.ask(pdu(4, {0xFF00 + identity::size, 1})), ElementsAre(0x84, 2)) << "the end of the area";
  EXPECT_THAT(node.ask({43, 14, 4, 6}),
              ElementsAre(43, 14, 4, 0x83, 0, 0, 1, 6, 6, 'c', 'e', 'l', 'l', '-', '7'));
  EXPECT_THAT(node.ask({43, 14, 4, 0x80}),
              ElementsAre(43, 14, 4, 0x83, 0, 0, 1, 0x80, 16, '0', '1', '2', '3', '4', '5', '6', '7', '8',
                          '9', 'a', 'b', 'c', 'd', 'e', 'f'));
}

TEST(Identity, A_node_with_a_watchdog_tells_its_timeout) {
  NodeUnderTest node(MapBuilder().watchdog({std::chrono::seconds(70)}).build());
  const auto timeout = registers(node.ask(pdu(4, {0xFF00 + identity::at_watchdog_timeout, 2})));
  EXPECT_THAT(timeout, ElementsAre(1, 0x1170)) << "70 s";
}

TEST(Identity, A_node_that_was_told_nothing_says_that_it_knows_nothing) {
  NodeUnderTest node(MapBuilder().build());
  const auto further =
      registers(node.ask(pdu(4, {0xFF00 + identity::at_further, 1 + identity::further_size})));
  ASSERT_EQ(further.size(), 40U);
  EXPECT_EQ(further[0], 39U);
  EXPECT_EQ(std::count(further.begin() + 1, further.end(), 0), 39);
  EXPECT_THAT(node.ask({43, 14, 4, 6}), ElementsAre(0xAB, 2));
  EXPECT_THAT(node.ask({43, 14, 4, 0x80}), ElementsAre(0xAB, 2));
}

TEST(MapFile, The_text_is_read_two_bytes_a_register_and_padded_with_a_zero) {
  NodeUnderTest node(MapBuilder().text("abcde").build());
  EXPECT_THAT(node.ask({0x14, 7, 6, 0, 1, 0, 0, 0, 3}),
              ElementsAre(0x14, 8, 7, 6, 'a', 'b', 'c', 'd', 'e', 0));
  EXPECT_THAT(node.ask({0x14, 14, 6, 0, 1, 0, 2, 0, 1, 6, 0, 1, 0, 0, 0, 1}),
              ElementsAre(0x14, 8, 3, 6, 'e', 0, 3, 6, 'a', 'b'));
}

TEST(MapFile, Records_behind_the_end_of_the_text_are_an_illegal_address) {
  NodeUnderTest node(MapBuilder().text("abcd").build());
  EXPECT_THAT(node.ask({0x14, 7, 6, 0, 1, 0, 0, 0, 3}), ElementsAre(0x94, 2));
  EXPECT_THAT(node.ask({0x14, 7, 6, 0, 1, 0, 2, 0, 1}), ElementsAre(0x94, 2));
  EXPECT_THAT(node.ask({0x14, 7, 6, 0, 2, 0, 0, 0, 1}), ElementsAre(0x94, 2));
  EXPECT_THAT(node.ask({0x14, 14, 6, 0, 1, 0, 0, 0, 1, 6, 0, 9, 0, 0, 0, 1}), ElementsAre(0x94, 2));
}

TEST(MapFile, A_long_text_is_the_same_when_it_is_put_together_again) {
  std::string text;
  while (text.size() < 45001) text += "line " + std::to_string(text.size()) + "\n";
  std::string read;
  const auto size = static_cast<std::uint32_t>(text.size());
  for (std::uint32_t first = 0; 2 * first < size;) {
    const auto record = identity::record_at(first, size);
    std::vector<std::uint8_t> bytes(std::size_t{2} * record.registers);
    ASSERT_TRUE(read_map_file(text, record, bytes));
    read.append(bytes.begin(), bytes.end());
    first += record.registers;
  }
  read.resize(text.size());
  EXPECT_EQ(read, text);
}

}  // namespace
}  // namespace coupler::device
